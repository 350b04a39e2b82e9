#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "engine/app/command_line.h"
#include "engine/app/ending.h"
#include "engine/files/version.h"

namespace poesy::app {
namespace {

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
  text += section("EXIT STATUS") + items(exit_codes());
  text += section("FILES") + items(files());
  text += section("ENVIRONMENT") + items(environment());
  return text + section("EXAMPLES") + examples_text(program);
}

}  // namespace

Command& add_man(Command& program) {
  Command& command = program.add_command("man", "print the manual page, for man");
  command.examples = {{"read it", "poesy man | man -l -"}};
  command.action = [&program] {
    std::fputs(man_page(program).c_str(), stdout);
    return kDone;
  };
  return command;
}

}  // namespace poesy::app
