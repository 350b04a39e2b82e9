#include "engine/app/man_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/app/reference.h"
#include "engine/io/version.h"

namespace poesy::app {
namespace {

/// Text as roff prints it, character by character.
std::string roff(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else if (c == '\'') {
      safe += "\\(aq";
    } else if (c == '^') {
      safe += "\\(ha";
    } else if (c == '~') {
      safe += "\\(ti";
    } else {
      safe += c;
    }
  }
  return text.starts_with('.') ? "\\&" + safe : safe;
}

std::string bold(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + roff(text) + "\\fR"; }

std::string section(const std::string& name) { return ".SH " + name + "\n"; }

/// What is explained stands out, its meaning is indented.
std::string item(const std::string& head, std::string_view meaning) {
  return ".TP\n" + head + "\n" + roff(meaning) + "\n";
}

std::string items(std::span<const Entry> entries) {
  std::string text;
  for (const auto& [name, meaning] : entries) text += item(bold(name), meaning);
  return text;
}

std::string option_item(const DescribedOption& option) {
  std::string head;
  for (const std::string& name : option.names) head += (head.empty() ? "" : ", ") + bold(name);
  if (!option.value.empty()) head += (head.empty() ? "" : " ") + italic(option.value);
  return item(option.repeated ? head + " ..." : head, option.about);
}

std::string examples_text(const DescribedCommand& command) {
  std::string text;
  for (const auto& [about, line] : command.examples) text += item(bold(line), about);
  return text;
}

std::string command_text(const DescribedCommand& command) {
  std::string text =
      ".SS poesy " + roff(command.name) + "\n" + bold(synopsis(command)) + "\n.PP\n" + roff(command.about) + "\n";
  // The option --help is told of once, for all commands.
  for (const DescribedOption& option : command.options) {
    if (option.by_place() || option.names.back() != "--help") text += option_item(option);
  }
  for (const std::string& note : command.notes) text += ".PP\n" + roff(note) + "\n";
  if (!command.examples.empty()) text += ".PP\nExamples:\n" + examples_text(command);
  return text;
}

}  // namespace

std::string man_page(const DescribedProgram& described) {
  const DescribedCommand& program = described.program;
  std::string text = fmt::format(".TH POESY 1 \"\" \"poesy {}\" \"User Commands\"\n", poesy_version());
  text += section("NAME") + "poesy \\- " + roff(program.about) + "\n";
  text += section("SYNOPSIS") + ".B poesy\n" + italic("COMMAND") + " [arguments] [options]\n";
  text += section("DESCRIPTION");
  for (const std::string& note : program.notes) text += ".PP\n" + roff(note) + "\n";
  text += section("OPTIONS");
  for (const DescribedOption& option : program.options) text += option_item(option);
  text += section("COMMANDS");
  for (const DescribedCommand& command : described.commands) text += command_text(command);
  text += section("EXIT STATUS") + items(exit_codes());
  text += section("FILES") + items(files());
  text += section("ENVIRONMENT") + items(environment());
  return text + section("EXAMPLES") + examples_text(program);
}

}  // namespace poesy::app
