#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>

#include "engine/app/command_line.h"
#include "engine/app/terminal.h"
#include "engine/base/text.h"
#include "engine/report/table.h"

namespace poesy::app {
namespace {

/// An entry of a list in help: a name and its meaning.
struct Entry {
  std::string_view name;
  std::string_view meaning;
};
constexpr std::array kExitCodes{
    Entry{"0", "done"},
    Entry{"1", "internal error; please report it"},
    Entry{"2", "bad command line, study or data; nothing is written"},
    Entry{"3", "a file cannot be read, written or trusted, or memory is too little"},
    Entry{"4", "interrupted: poesy run goes on with --resume, poesy evaluate wrote nothing"},
    Entry{"5", "done and the result kept, but more samples failed to converge than the study allows, or a fit did not"},
    Entry{"6", "done and the result kept, but a limit that the study states is not kept; 5 goes before it"}};
constexpr std::array kFiles{Entry{"STUDY.toml", "what to compute; poesy template writes one to start from"},
                            Entry{"RESULT.h5", "what was found; HDF5, whole or absent"},
                            Entry{"RESULT.h5.part", "checkpoint of a run; the one before it is RESULT.h5.part.1"},
                            Entry{"RESULT.h5.lock", "there while a run writes to this result"},
                            Entry{"RESULT.h5.tmp.*", "left by a kill; the next run removes it"}};
constexpr std::array kEnvironment{
    Entry{"NO_COLOR", "if it is set and not empty, nothing is coloured"},
    Entry{"TERM", "if it is unset or 'dumb', nothing is coloured, and progress comes line by line"},
    Entry{"POESY_ISA", "instruction set of the kernels, instead of the best that the processor has"}};

constexpr std::size_t kNarrowest = 30;
constexpr std::size_t kWidest = 110;     ///< longer lines are hard to read
constexpr std::size_t kTwoColumns = 72;  ///< if help is narrower than this, meanings are below names
constexpr std::size_t kMeanings = 28;    ///< column at which meanings begin
constexpr std::size_t kBelow = 6;

/// The width of help in columns.
std::size_t help_width() {
  const std::size_t width = output_width();
  return width == kUnlimitedWidth ? kUsualWidth : std::clamp(width, kNarrowest, kWidest);
}

/// A paragraph of help. begin: text in front of the first line. indent: column at which further lines start.
std::string paragraph(const std::string& words, std::size_t indent = 0, const std::string& begin = {}) {
  const auto lines = wrapped(words, help_width() - indent, help_width() - begin.size());
  return fmt::format("{}{}\n", begin, fmt::join(lines, "\n" + std::string(indent, ' ')));
}

/// A name in help, with the meaning beside it or below it.
std::string entry(std::string_view name, std::string_view meaning) {
  std::string begin = fmt::format("  {}", name);
  std::string above;
  const std::size_t indent = help_width() < kTwoColumns ? kBelow : kMeanings;
  if (begin.size() + 2 > indent) {
    above = begin + "\n";
    begin.clear();
  }
  begin.resize(indent, ' ');
  return above + paragraph(std::string(meaning), indent, begin);
}

std::string entries(const std::string& title, std::span<const Entry> list) {
  std::string text = "\n" + title + "\n";
  for (const auto& [name, meaning] : list) text += entry(name, meaning);
  return text;
}

/// Formats help with the groups of options and commands that CLI11 knows, wrapped to the width of the terminal. The
/// manual page is made from the help of all commands by help2man.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { label("Positionals", "Arguments"); }

  std::string make_help(const CLI::App* app, std::string /*name*/, CLI::AppFormatMode mode) const override {
    const auto& command = dynamic_cast<const Command&>(*app);
    if (mode == CLI::AppFormatMode::Sub) return expanded(command);
    const bool all = mode == CLI::AppFormatMode::All;
    std::string text = paragraph(title(command) + ": " + command.get_description());
    text += "\n" + paragraph("Usage: " + synopsis(command), kBelow) + notes(command) + make_positionals(app);
    text += (all ? "\n*Commands*\n" : "") + make_subcommands(app, mode) + make_groups(app, mode);
    if (command.get_parent() == nullptr) {
      text += entries(all ? "*Exit status*" : "Exit codes:", kExitCodes);
      text += entries("Files:", kFiles) + entries("Environment:", kEnvironment);
    }
    return CLI::detail::find_and_replace(text + examples(command), "\n\n\n", "\n\n");
  }

  std::string make_option(const CLI::Option* option, bool /*is_positional*/) const override {
    return entry(heading(*option), option->get_description());
  }

  std::string make_subcommand(const CLI::App* command) const override {
    return entry(command->get_name(), command->get_description());
  }

 private:
  /// The description, options, notes and examples of a command, indented as a part of the help of all commands.
  std::string expanded(const Command& command) const {
    std::string text = "\n" + paragraph(command.get_description()) + make_positionals(&command);
    text += make_groups(&command, CLI::AppFormatMode::Sub) + notes(command) + examples(command);
    text.pop_back();
    text = CLI::detail::find_and_replace(text, "\n", "\n  ");
    return "\n" + synopsis(command) + ":" + CLI::detail::find_and_replace(text, "\n  \n", "\n\n") + "\n";
  }

  static std::string notes(const Command& command) {
    std::string text;
    for (const std::string& note : command.notes) text += "\n" + paragraph(note);
    return text;
  }

  static std::string examples(const Command& command) {
    std::string text = command.examples.empty() ? "" : "\nExamples:\n";
    for (const auto& [about, line] : command.examples) text += entry(line, about);
    return text;
  }
};

int print_help(const Command& program, const std::string& name) {
  const Command* explained = &program;
  for (const Command* command : program.commands()) {
    if (command->get_name() == name) explained = command;
  }
  if (explained == &program && !name.empty()) return complain(unknown_command(name, program), kBadInput);
  print(program.get_formatter()->make_help(explained, "", CLI::AppFormatMode::Normal));
  return kDone;
}

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_formatter() { return std::make_shared<HelpFormatter>(); }

Command& add_help(Command& program) {
  Command& command = program.add_command("help", "explain a command, or list all of them");
  const auto name = std::make_shared<std::string>();
  command.add_value("command", *name, "COMMAND", "command to explain");
  command.examples = {{"what can poesy do?", "poesy help"}, {"the options of a run", "poesy help run"}};
  command.action = [name, &program] { return print_help(program, *name); };
  return command;
}

Command& add_version(Command& program) {
  Command& command = program.add_command("version", "print the version");
  command.examples = {{"version and commit", "poesy version"}};
  command.action = [&program] {
    std::puts(program.version().c_str());
    return kDone;
  };
  return command;
}

}  // namespace poesy::app
