#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

#include "engine/app/command_line.h"
#include "engine/app/ending.h"
#include "engine/app/terminal.h"
#include "engine/base/text.h"
#include "engine/report/table.h"

namespace poesy::app {
namespace {

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
  help.entries("Exit codes", exit_codes());
  help.entries("Files", files());
  help.add("\n");
  help.paragraph("poesy COMMAND --help explains a command, poesy man all of them.");
}

int print_help(const Command& program, const std::string& name) {
  const Command* explained = &program;
  for (const Command* command : program.commands()) {
    if (command->get_name() == name) explained = command;
  }
  if (explained == &program && !name.empty()) return complain(unknown_command(name, program), kBadInput);
  std::fputs(help_text(*explained).c_str(), stdout);
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

}  // namespace poesy::app
