#include "engine/app/help_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/app/description.h"
#include "engine/app/reference.h"
#include "engine/app/terminal.h"
#include "engine/base/text.h"
#include "engine/report/text_table.h"

namespace poesy::app {
namespace {

constexpr std::size_t kNarrowest = 30;
constexpr std::size_t kWidest = 110;     ///< longer lines are hard to read
constexpr std::size_t kTwoColumns = 72;  ///< narrower: what a thing means stands below it
constexpr std::size_t kMeanings = 28;    ///< column where meanings begin
constexpr std::size_t kBelow = 6;

/// Text in lines that end before column `width`. Its first line begins at column `at`, the others at column `indent`.
std::string wrapped(std::string_view text, std::size_t at, std::size_t indent, std::size_t width) {
  const std::vector<std::string> lines = poesy::wrapped(text, width - indent, width - at);
  return fmt::format("{}\n", fmt::join(lines, "\n" + std::string(indent, ' ')));
}

std::string entry(const std::string& name, const std::string& meaning, std::size_t width) {
  std::string text = "  " + name;
  const std::size_t indent = width < kTwoColumns ? kBelow : kMeanings;
  if (text.size() + 2 > indent) {
    text += "\n" + std::string(indent, ' ');
  } else {
    text.resize(indent, ' ');
  }
  return text + wrapped(meaning, indent, indent, width);
}

std::string entries(const std::string& title, std::span<const Entry> list, std::size_t width) {
  std::string text = "\n" + title + ":\n";
  for (const auto& [name, meaning] : list) text += entry(std::string(name), std::string(meaning), width);
  return text;
}

/// Things by their groups, in the order in which groups appear.
template <class Things, class Write>
std::string grouped(const Things& things, Write write) {
  std::vector<std::string> groups;
  for (const auto& thing : things) {
    if (std::ranges::find(groups, thing.group) == groups.end()) groups.push_back(thing.group);
  }
  std::string text;
  for (const std::string& group : groups) {
    text += "\n" + group + ":\n";
    for (const auto& thing : things) {
      if (thing.group == group) text += write(thing);
    }
  }
  return text;
}

/// Arguments first, and last what every command has.
int rank(const DescribedOption& option) {
  if (option.by_place()) return 0;
  return option.names.back() == "--help" || option.names.back() == "--version" ? 2 : 1;
}

std::string options_text(const DescribedCommand& command, std::size_t width) {
  std::vector<DescribedOption> options = command.options;
  std::ranges::stable_sort(options, {}, rank);
  for (DescribedOption& option : options) {
    if (option.by_place()) option.group = "Arguments";
  }
  return grouped(options, [&](const DescribedOption& option) { return entry(heading(option), option.about, width); });
}

std::string notes_text(const DescribedCommand& command, std::size_t width) {
  std::string text;
  for (const std::string& note : command.notes) text += "\n" + wrapped(note, 0, 0, width);
  if (command.examples.empty()) return text;
  text += "\nExamples:\n";
  for (const auto& [about, line] : command.examples) {
    text += "  " + line + "\n" + std::string(kBelow, ' ') + wrapped(about, kBelow, kBelow, width);
  }
  return text;
}

std::string command_help(const DescribedCommand& command, std::size_t width) {
  const std::string begin = "Usage: ";
  return wrapped("poesy " + command.name + ": " + command.about, 0, 2, width) + "\n" + begin +
         wrapped(synopsis(command), begin.size(), begin.size() + 2, width) + options_text(command, width) +
         notes_text(command, width);
}

std::string program_help(const DescribedProgram& described, std::size_t width) {
  const DescribedCommand& program = described.program;
  return wrapped("poesy: " + program.about, 0, 2, width) + "\nUsage: poesy COMMAND [arguments] [options]\n" +
         grouped(described.commands,
                 [&](const DescribedCommand& command) { return entry(command.name, command.about, width); }) +
         options_text(program, width) + notes_text(program, width) + entries("Exit codes", exit_codes(), width) +
         entries("Files", files(), width) + "\n" +
         wrapped("poesy COMMAND --help explains a command, poesy man all of them.", 0, 0, width);
}

}  // namespace

std::string help_text(const CLI::App& app, std::size_t width) {
  return app.get_parent() == nullptr ? program_help(describe(app), width) : command_help(describe_command(app), width);
}

std::size_t help_width() {
  const std::size_t width = output_width();
  return width == kUnlimitedWidth ? kUsualWidth : std::clamp(width, kNarrowest, kWidest);
}

}  // namespace poesy::app
