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

/// Reads a text of digits alone; empty for anything else.
std::optional<std::uint64_t> whole_number(std::string_view text);
/// Throws InputError that names the option and both bounds unless the text is a whole number within them.
std::uint64_t parse_whole_number(const std::string& text, const std::string& option, std::uint64_t least,
                                 std::uint64_t most);

/// A command line, and what it is an example of.
struct Example {
  std::string about;
  std::string line;
};

/// The program, or one of its commands: what CLI11 has to know, and the notes and examples of its help.
class Command : public CLI::App {
 public:
  /// program: that the command belongs to; null for the program itself.
  Command(const std::string& name, const std::string& about, Command* program = nullptr)
      : CLI::App(about, name, program) {}

  std::vector<std::string> notes;  ///< paragraphs
  std::vector<Example> examples;
  std::function<int()> action;  ///< once the command line is understood; gives the exit code

  /// One more command of this program, and what its command line sets for its action.
  template <class Options>
  std::pair<Command&, Options&> add_command(const std::string& name, const std::string& about,
                                            int (*run)(const Options&)) {
    Command& command = add_command(name, about);
    const auto options = std::make_shared<Options>();
    command.action = [options, run] { return run(*options); };
    return {command, *options};
  }
  /// The same without action.
  Command& add_command(const std::string& name, const std::string& about);
  /// All commands of this program, as they were added.
  std::vector<const Command*> commands() const;

  /// An option ("-o,--output"), or an argument that its place tells ("study"), with a value that help calls `value`.
  template <class Variable>
  CLI::Option* add_value(const std::string& name, Variable& variable, const std::string& value,
                         const std::string& about) {
    return add_option(name, variable, about)->type_name(value);
  }
  /// The same for a whole number from `least` to `most`.
  template <class Number>
  CLI::Option* add_whole_number(const std::string& name, Number& number, const std::string& value,
                                const std::string& about, std::uint64_t least, std::uint64_t most) {
    const std::string shown = name.starts_with('-') ? name : value;
    const auto parse = [=, &number](const std::string& text) { number = parse_whole_number(text, shown, least, most); };
    return add_option_function<std::string>(name, parse, about)->type_name(value);
  }
};

// Each adds one command to the program.
Command& add_run(Command& program);
Command& add_check(Command& program);
Command& add_evaluate(Command& program);
Command& add_show(Command& program);
Command& add_report(Command& program);
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

/// "-o", "--output"; empty for an argument that its place tells.
std::vector<std::string> names_of(const CLI::Option& option);

/// Of all options of a command.
std::vector<std::string> option_names(const CLI::App& command);

/// "RESULT.h5"; empty for a flag.
std::string value_of(const CLI::Option& option);

/// Whether it takes several values.
bool is_repeated(const CLI::Option& option);

/// "-o, --output RESULT.h5", "SHARD.h5 ..."
std::string heading(const CLI::Option& option);

/// "poesy run", or "poesy".
std::string title(const CLI::App& command);

/// "poesy evaluate STUDY.toml --poses P.csv --errors E.csv [options]"
std::string synopsis(const CLI::App& command);

/// Prints help of the program and of its commands, in as many columns as stdout has.
std::shared_ptr<CLI::FormatterBase> help_formatter();

/// What is wrong with the command line that CLI11 refused, and what to do: "problem; remedy". Names the nearest command
/// or option that there is.
std::string command_line_problem(const Command& program, const CLI::ParseError& error);

/// "no command 'rn'; did you mean 'run'? see poesy --help".
std::string unknown_command(const std::string& word, const Command& program);

/// What is wrong with a command line that gives an option or an argument an empty text, as a script does whose variable
/// is not set, or an option another option for its value; none where none does. Precondition: CLI11 took the command
/// line.
std::optional<std::string> impossible_value(const Command& program);

/// Whether the command line begins with a command that does not exist.
bool has_unknown_command(const Command& program);

}  // namespace poesy::app
