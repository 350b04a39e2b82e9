#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace poesy::app {

/// The whole number in a text that has only digits; none for any other text.
std::optional<std::uint64_t> whole_number(std::string_view text);
/// Reads a whole number from `least` to `most`. For any other text, throws InputError with the name of the option and
/// the bounds.
std::uint64_t parse_whole_number(const std::string& text, const std::string& option, std::uint64_t least,
                                 std::uint64_t most);

/// An example of a command line in help, with its purpose.
struct Example {
  std::string about;
  std::string line;
};

/// The program or one of its commands: a CLI11 app with the notes and the examples of its help.
class Command : public CLI::App {
 public:
  /// program: the program to which the command belongs; null for the program itself.
  Command(const std::string& name, const std::string& about, Command* program = nullptr)
      : CLI::App(about, name, program) {}

  std::vector<std::string> notes;  ///< paragraphs at the end of the help
  std::vector<Example> examples;
  std::function<int()> action;  ///< runs the command and returns the exit code; called after reading the command line

  /// Adds a command to this program. run: is called with the options that the user set. Returns the command and its
  /// options; the caller adds the options to the command line.
  template <class Options>
  std::pair<Command&, Options&> add_command(const std::string& name, const std::string& about,
                                            int (*run)(const Options&)) {
    Command& command = add_command(name, about);
    const auto options = std::make_shared<Options>();
    command.action = [options, run] { return run(*options); };
    return {command, *options};
  }
  /// Adds a command without an action.
  Command& add_command(const std::string& name, const std::string& about);
  /// The commands of this program, in the order in which they were added.
  std::vector<const Command*> commands() const;

  /// Adds an option ("-o,--output") or a positional argument ("study") that has a value. value: word for the value in
  /// help.
  template <class Variable>
  CLI::Option* add_value(const std::string& name, Variable& variable, const std::string& value,
                         const std::string& about) {
    return add_option(name, variable, about)->type_name(value);
  }
  /// Adds an option or a positional argument that is a whole number from `least` to `most`. value: word for the number
  /// in help.
  template <class Number>
  CLI::Option* add_whole_number(const std::string& name, Number& number, const std::string& value,
                                const std::string& about, std::uint64_t least, std::uint64_t most) {
    const std::string shown = name.starts_with('-') ? name : value;
    const auto parse = [=, &number](const std::string& text) { number = parse_whole_number(text, shown, least, most); };
    return add_option_function<std::string>(name, parse, about)->type_name(value);
  }
};

// Each of these functions adds one command to the program.
Command& add_run(Command& program);
Command& add_sweep(Command& program);
Command& add_check(Command& program);
Command& add_evaluate(Command& program);
Command& add_calibrate(Command& program);
Command& add_show(Command& program);
Command& add_report(Command& program);
Command& add_figure(Command& program);
Command& add_replay(Command& program);
Command& add_export(Command& program);
Command& add_merge(Command& program);
Command& add_verify(Command& program);
Command& add_models(Command& program);
Command& add_template(Command& program);
Command& add_tolerances(Command& program);
Command& add_completion(Command& program);
Command& add_help(Command& program);
Command& add_version(Command& program);

/// The names of an option: "-o", "--output". A positional argument has none.
std::vector<std::string> names_of(const CLI::Option& option);

/// The names of all options of a command.
std::vector<std::string> option_names(const CLI::App& command);

/// The word for an option's value in help: "RESULT.h5". Empty for a flag.
std::string value_of(const CLI::Option& option);

/// Returns true if an option takes several values.
bool is_repeated(const CLI::Option& option);

/// The heading of an option or an argument in help: "-o, --output RESULT.h5", "SHARD.h5 ...".
std::string heading(const CLI::Option& option);

/// The words with which a command is called: "poesy run". For the program itself: "poesy".
std::string title(const CLI::App& command);

/// The synopsis of a command: "poesy evaluate STUDY.toml --poses P.csv --errors E.csv [options]".
std::string synopsis(const CLI::App& command);

/// Makes the formatter for the help of the program and of its commands. It wraps help at the width of stdout.
std::shared_ptr<CLI::FormatterBase> help_formatter();

/// The message about a command line that CLI11 refused: "PROBLEM; REMEDY". It suggests the most similar command or
/// option.
std::string command_line_problem(const Command& program, const CLI::ParseError& error);

/// The message for a word that is not the name of a command: "no command 'rn'; did you mean 'run'? see poesy --help".
std::string unknown_command(const std::string& word, const Command& program);

/// The message that a value in the command line is impossible; none if all values are possible. A value is impossible
/// if it is empty, which happens in a script with a variable that is not set, or if it is the name of an option.
/// Precondition: CLI11 accepted the command line.
std::optional<std::string> impossible_value(const Command& program);

/// Returns true if the command line begins with a command that does not exist.
bool has_unknown_command(const Command& program);

}  // namespace poesy::app
