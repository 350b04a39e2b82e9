#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <utility>

#include "engine/app/command_line.h"
#include "engine/app/terminal.h"
#include "engine/base/text.h"
#include "engine/report/table.h"
#include "engine/storage/version.h"

namespace poesy::app {
namespace {

/// A name and what it means, for help and manual.
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
    Entry{"5", "done and the result kept, but more samples failed to converge than the study allows"},
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
constexpr std::size_t kTwoColumns = 72;  ///< narrower: what a thing means is below it
constexpr std::size_t kMeanings = 28;    ///< column where meanings begin
constexpr std::size_t kBelow = 6;

/// Columns for help on stdout.
std::size_t help_width() {
  const std::size_t width = output_width();
  return width == kUnlimitedWidth ? kUsualWidth : std::clamp(width, kNarrowest, kWidest);
}

/// Writes help in so many columns.
class HelpWriter {
 public:
  explicit HelpWriter(std::size_t width) : width_(width) {}

  const std::string& text() const { return text_; }

  /// Lines as they are.
  void add(const std::string& lines) { text_ += lines; }

  /// A paragraph behind `begin`; its further lines begin at column `indent`.
  void paragraph(const std::string& words, std::size_t indent = 0, const std::string& begin = {}) {
    const auto lines = wrapped(words, width_ - indent, width_ - begin.size());
    text_ += fmt::format("{}{}\n", begin, fmt::join(lines, "\n" + std::string(indent, ' ')));
  }

  /// A name, and beside or below it what it means.
  void entry(std::string_view name, std::string_view meaning) {
    std::string begin = "  " + std::string(name);
    const std::size_t indent = width_ < kTwoColumns ? kBelow : kMeanings;
    if (begin.size() + 2 > indent) {
      text_ += begin + "\n";
      begin.clear();
    }
    begin.resize(indent, ' ');
    paragraph(std::string(meaning), indent, begin);
  }

  void entries(const std::string& title, std::span<const Entry> list) {
    text_ += "\n" + title + ":\n";
    for (const auto& [name, meaning] : list) entry(name, meaning);
  }

  /// Options or commands by their groups, in the order in which groups appear. An argument's group is "Arguments".
  template <class Things, class Name>
  void groups(const Things& things, const Name& name) {
    const auto group_of = [](const auto* thing) {
      if constexpr (requires { thing->get_positional(); }) {
        if (thing->get_positional()) return std::string("Arguments");
      }
      return thing->get_group();
    };
    std::vector<std::string> groups;
    for (const auto* thing : things) {
      if (std::ranges::find(groups, group_of(thing)) == groups.end()) groups.push_back(group_of(thing));
    }
    for (const std::string& group : groups) {
      text_ += "\n" + group + ":\n";
      for (const auto* thing : things) {
        if (group_of(thing) == group) entry(name(*thing), thing->get_description());
      }
    }
  }

  /// Arguments first, and last what every command has.
  void options(const Command& command) {
    const auto rank = [](const CLI::Option* option) {
      if (option->get_positional()) return 0;
      const std::string name = names_of(*option).back();
      return name == "--help" || name == "--version" ? 2 : 1;
    };
    std::vector<const CLI::Option*> options = command.get_options();
    std::ranges::stable_sort(options, {}, rank);
    groups(options, heading);
  }

  void notes(const Command& command) {
    for (const std::string& note : command.notes) {
      text_ += "\n";
      paragraph(note);
    }
    if (command.examples.empty()) return;
    text_ += "\nExamples:\n";
    for (const auto& [about, line] : command.examples) {
      text_ += "  " + line + "\n";
      paragraph(about, kBelow, std::string(kBelow, ' '));
    }
  }

 private:
  std::size_t width_;
  std::string text_;
};

void write_command(const Command& command, HelpWriter& help) {
  help.paragraph("poesy " + command.get_name() + ": " + command.get_description(), 2);
  help.add("\n");
  const std::string begin = "Usage: ";
  help.paragraph(synopsis(command), begin.size() + 2, begin);
  help.options(command);
  help.notes(command);
}

void write_program(const Command& program, HelpWriter& help) {
  help.paragraph("poesy: " + program.get_description(), 2);
  help.add("\nUsage: poesy COMMAND [arguments] [options]\n");
  help.groups(program.commands(), [](const Command& command) { return command.get_name(); });
  help.options(program);
  help.notes(program);
  help.entries("Exit codes", kExitCodes);
  help.entries("Files", kFiles);
  help.add("\n");
  help.paragraph("poesy COMMAND --help explains a command, poesy man all of them.");
}

/// Text as roff prints it, character by character.
std::string roff(std::string_view text) {
  constexpr std::array<std::pair<char, std::string_view>, 5> kNames{
      {{'\\', "\\e"}, {'-', "\\-"}, {'\'', "\\(aq"}, {'^', "\\(ha"}, {'~', "\\(ti"}}};
  std::string safe;
  for (const char c : text) {
    const auto* named = std::ranges::find(kNames, c, &std::pair<char, std::string_view>::first);
    safe += named != kNames.end() ? named->second : std::string_view(&c, 1);
  }
  return text.starts_with('.') ? "\\&" + safe : safe;
}

std::string bold(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + roff(text) + "\\fR"; }

std::string section(const std::string& name) { return ".SH " + name + "\n"; }

/// A name at the margin, its meaning indented.
std::string item(const std::string& head, std::string_view meaning) {
  return ".TP\n" + head + "\n" + roff(meaning) + "\n";
}

std::string items(std::span<const Entry> entries) {
  std::string text;
  for (const auto& [name, meaning] : entries) text += item(bold(name), meaning);
  return text;
}

std::string option_item(const CLI::Option& option) {
  std::string head;
  for (const std::string& name : names_of(option)) head += (head.empty() ? "" : ", ") + bold(name);
  if (const std::string value = value_of(option); !value.empty()) head += (head.empty() ? "" : " ") + italic(value);
  return item(is_repeated(option) ? head + " ..." : head, option.get_description());
}

std::string examples_text(const Command& command) {
  std::string text;
  for (const auto& [about, line] : command.examples) text += item(bold(line), about);
  return text;
}

std::string notes_text(const Command& command) {
  std::string text;
  for (const std::string& note : command.notes) text += ".PP\n" + roff(note) + "\n";
  return text;
}

std::string command_text(const Command& command) {
  std::string text = ".SS poesy " + roff(command.get_name()) + "\n" + bold(synopsis(command)) + "\n.PP\n" +
                     roff(command.get_description()) + "\n";
  // The option --help is told of once, for all commands.
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional() || names_of(*option).back() != "--help") text += option_item(*option);
  }
  text += notes_text(command);
  if (!command.examples.empty()) text += ".PP\nExamples:\n" + examples_text(command);
  return text;
}

/// The manual page poesy(1), with the macros of man(7).
std::string man_page(const Command& program) {
  std::string text = fmt::format(".TH POESY 1 \"\" \"poesy {}\" \"User Commands\"\n", poesy_version());
  text += section("NAME") + "poesy \\- " + roff(program.get_description()) + "\n";
  text += section("SYNOPSIS") + ".B poesy\n" + italic("COMMAND") + " [arguments] [options]\n";
  text += section("DESCRIPTION") + notes_text(program);
  text += section("OPTIONS");
  for (const CLI::Option* option : program.get_options()) text += option_item(*option);
  text += section("COMMANDS");
  for (const Command* command : program.commands()) text += command_text(*command);
  text += section("EXIT STATUS") + items(kExitCodes);
  text += section("FILES") + items(kFiles);
  text += section("ENVIRONMENT") + items(kEnvironment);
  return text + section("EXAMPLES") + examples_text(program);
}

int print_help(const Command& program, const std::string& name) {
  const Command* explained = &program;
  for (const Command* command : program.commands()) {
    if (command->get_name() == name) explained = command;
  }
  if (explained == &program && !name.empty()) return complain(unknown_command(name, program), kBadInput);
  print(help_text(*explained));
  return kDone;
}

}  // namespace

std::string help_text(const Command& command) {
  HelpWriter help(help_width());
  if (command.get_parent() == nullptr) {
    write_program(command, help);
  } else {
    write_command(command, help);
  }
  return help.text();
}

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

Command& add_man(Command& program) {
  Command& command = program.add_command("man", "print the manual page, for man");
  command.examples = {{"read it", "poesy man | man -l -"}};
  command.action = [&program] {
    print(man_page(program));
    return kDone;
  };
  return command;
}

}  // namespace poesy::app
