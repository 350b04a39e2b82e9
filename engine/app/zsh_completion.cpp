#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/app/shell_scripts.h"

namespace poesy::app {
namespace {

/// With a backslash before each of these characters, and fit to stand between single quotes.
std::string escaped(const std::string& text, std::string_view special) {
  std::string safe;
  for (const char c : text) {
    if (c == '\'') {
      safe += "'\\''";
      continue;
    }
    if (special.find(c) != std::string_view::npos) safe += '\\';
    safe += c;
  }
  return safe;
}

std::string action(const Offer& offer) {
  switch (offer.kind) {
    case Offer::Kind::words:
      return fmt::format("({})", fmt::join(offer.words, " "));
    case Offer::Kind::files:
      return fmt::format("_files -g \"*.{}\"", offer.extension);
    case Offer::Kind::folders:
      return "_files -/";
    case Offer::Kind::nothing:
      break;
  }
  return " ";
}

/// ":RESULT.h5:_files ..."; empty of a flag.
std::string value_of(const DescribedOption& option) {
  if (option.value.empty()) return {};
  return fmt::format(":{}:{}", escaped(option.value, ":\\"), action(option.offer));
}

/// One argument of _arguments.
std::string specification(const DescribedOption& option, std::size_t place) {
  if (option.by_place()) {
    const std::string where = option.repeated ? "*" : fmt::format("{}{}", place, option.required ? "" : ":");
    return fmt::format("'{}{}'", where, value_of(option));
  }
  const std::string rest = fmt::format("[{}]{}'", escaped(option.about, "[]:\\"), value_of(option));
  if (option.names.size() == 1) return fmt::format("'{}{}", option.names.front(), rest);
  return fmt::format("'({})'{{{}}}'{}", fmt::join(option.names, " "), fmt::join(option.names, ","), rest);
}

std::string arguments(const DescribedCommand& command, std::string_view indent) {
  std::string text = "_arguments";
  std::size_t place = 0;
  for (const DescribedOption& option : command.options) {
    if (option.by_place()) ++place;
    text += fmt::format(" \\\n{}{}", indent, specification(option, place));
  }
  return text;
}

}  // namespace

std::string zsh_completion(const DescribedProgram& described) {
  std::string commands;
  std::string cases;
  for (const DescribedCommand& command : described.commands) {
    commands += fmt::format("    '{}:{}'\n", command.name, escaped(command.about, ":\\"));
    cases += fmt::format("        {})\n          {} ;;\n", command.name, arguments(command, "            "));
  }
  return fmt::format(
      "#compdef poesy\n"
      "# zsh completion for poesy, written by 'poesy completion zsh'\n\n"
      "_poesy() {{\n"
      "  local curcontext=$curcontext state line\n"
      "  typeset -A opt_args\n"
      "  local -a commands=(\n{}  )\n"
      "  _arguments -C{} \\\n"
      "    '1:command:->command' \\\n"
      "    '*::argument:->argument' && return\n"
      "  case $state in\n"
      "    command)\n"
      "      _describe -t commands 'command of poesy' commands ;;\n"
      "    argument)\n"
      "      case $words[1] in\n{}"
      "      esac ;;\n"
      "  esac\n"
      "}}\n\n"
      "if [[ $funcstack[1] == _poesy ]]; then\n"
      "  _poesy \"$@\"\n"
      "else\n"
      "  compdef _poesy poesy\n"
      "fi\n",
      commands, arguments(described.program, "    ").substr(std::string("_arguments").size()), cases);
}

}  // namespace poesy::app
