#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "engine/app/command_line.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/registry.h"
#include "engine/study/study.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

/// The shells for which there is a completion script.
constexpr std::array<std::string_view, 2> kShells{"bash", "zsh"};

/// What the script for each shell offers to complete a value, in the notation of the script.
struct Offer {
  std::string bash = "nothing";
  std::string zsh = " ";
};

/// The names of the responses of all mechanisms with all their metrics, each once.
std::vector<std::string_view> known_responses() {
  std::vector<std::string_view> names;
  const auto add = [&](const CatalogEntry& entry) {
    for (const Response& response : entry.description.responses) {
      if (std::ranges::find(names, response.name) == names.end()) names.push_back(response.name);
    }
  };
  for (const CatalogEntry& entry : registry()) {
    for (const CatalogEntry* by = &entry; by != nullptr; by = by->other_metric.get()) add(*by);
  }
  return names;
}

std::vector<std::string_view> words_for(const std::string& value, const Command& program) {
  if (value == "RESPONSE") return known_responses();
  if (value == "KIND") return names(study_kinds());
  if (value == "SHELL") return {kShells.begin(), kShells.end()};
  if (value == "KEY") return {kRowOrders.begin(), kRowOrders.end()};
  std::vector<std::string_view> words;
  if (value == "MODEL") {
    for (const CatalogEntry& entry : registry()) words.push_back(entry.description.name);
  } else if (value == "COMMAND") {
    for (const Command* command : program.commands()) words.push_back(command->get_name());
  }
  return words;
}

/// How the scripts complete the value of an option. The word for the value in help ("DIR") tells what kind of value it
/// is.
Offer offer_for(const CLI::Option& option, const Command& program) {
  const std::string value = value_of(option);
  if (value == "DIR") return {"folders", "_files -/"};
  for (const char* extension : {"toml", "h5", "csv", "html"}) {
    if (!value.ends_with(std::string(".") + extension)) continue;
    return {fmt::format("files {}", extension), fmt::format("_files -g \"*.{}\"", extension)};
  }
  const std::vector<std::string_view> words = words_for(value, program);
  if (words.empty()) return {};
  return {fmt::format("words {}", fmt::join(words, " ")), fmt::format("({})", fmt::join(words, " "))};
}

constexpr std::string_view kBashBegin = R"(# bash completion for poesy, written by 'poesy completion bash'

# Files with this extension, and folders.
_poesy_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -f -X "!*.$1" -- "$2"; compgen -d -- "$2")
}

_poesy_folders() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -d -- "$1")
}

)";

constexpr std::string_view kBashEnd = R"(
_poesy() {
  local cur=${COMP_WORDS[COMP_CWORD]} command= option= word value k place=1
  COMPREPLY=()
  for ((k = 1; k < COMP_CWORD; ++k)); do
    word=${COMP_WORDS[k]}
    if [[ -n $option ]]; then
      [[ $word == = ]] || option=
    elif [[ $word == -* ]]; then
      _poesy_value "$command $word" && option=$word
    elif [[ -z $command ]]; then
      command=$word
    else
      ((++place))
    fi
  done
  [[ $cur == = ]] && cur=
  if [[ -n $option ]]; then
    _poesy_value "$command $option"
  elif [[ $cur == -* ]] || { [[ -n $command ]] && ! _poesy_value "$command $place"; }; then
    _poesy_options "$command"
  elif [[ -z $command ]]; then
    value="words $_poesy_commands"
  fi
  case $value in
    'files '*) _poesy_files "${value#* }" "$cur" ;;
    folders) _poesy_folders "$cur" ;;
    'words '*) mapfile -t COMPREPLY < <(compgen -W "${value#* }" -- "$cur") ;;
  esac
}

complete -F _poesy poesy
)";

/// Lines of the function _poesy_value in bash. They complete the value of each option and each positional argument.
std::string bash_values(const Command& command, const Command& program) {
  std::string text;
  std::size_t place = 0;
  for (const CLI::Option* option : command.get_options()) {
    if (value_of(*option).empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : names_of(*option)) patterns.push_back("'" + command.get_name() + " " + name + "'");
    if (option->get_positional()) {
      patterns.push_back(is_repeated(*option) ? fmt::format("'{} '[0-9]*", command.get_name())
                                              : fmt::format("'{} {}'", command.get_name(), ++place));
    }
    text += fmt::format("    {}) value='{}' ;;\n", fmt::join(patterns, " | "), offer_for(*option, program).bash);
  }
  return text;
}

std::string bash_options(const CLI::App& command, const std::string& name) {
  return fmt::format("    '{}') value='words {}' ;;\n", name, fmt::join(option_names(command), " "));
}

/// The completion script for bash 4 or newer. It needs no other files or packages.
std::string bash_completion(const Command& program) {
  std::string names;
  std::string values;
  std::string options = bash_options(program, "");
  for (const Command* command : program.commands()) {
    names += (names.empty() ? "" : " ") + command->get_name();
    values += bash_values(*command, program);
    options += bash_options(*command, command->get_name());
  }
  return fmt::format(
      "{}_poesy_commands='{}'\n\n"
      "# Sets value: what stands after an option, or at a place. Fails where nothing does.\n"
      "_poesy_value() {{\n  value=\n  case $1 in\n{}    *) return 1 ;;\n  esac\n}}\n\n"
      "# Sets value: the options of a command, or of the program.\n"
      "_poesy_options() {{\n  value=\n  case $1 in\n{}  esac\n}}\n{}",
      kBashBegin, names, values, options, kBashEnd);
}

/// Puts a backslash before each of the special characters, and makes the text safe between single quotes.
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

/// The end of an option's description for zsh, which describes the option's value: ":RESULT.h5:_files ...". Empty for a
/// flag.
std::string zsh_value(const CLI::Option& option, const Command& program) {
  const std::string value = value_of(option);
  if (value.empty()) return {};
  return fmt::format(":{}:{}", escaped(value, ":\\"), offer_for(option, program).zsh);
}

/// An option or a positional argument, in the form of zsh's _arguments. place: number of the positional argument.
std::string zsh_argument(const CLI::Option& option, std::size_t place, const Command& program) {
  const std::string value = zsh_value(option, program);
  if (option.get_positional()) {
    const std::string where = is_repeated(option) ? "*" : fmt::format("{}{}", place, option.get_required() ? "" : ":");
    return fmt::format("'{}{}'", where, value);
  }
  const std::vector<std::string> names = names_of(option);
  const std::string rest = fmt::format("[{}]{}'", escaped(option.get_description(), "[]:\\"), value);
  if (names.size() == 1) return fmt::format("'{}{}", names.front(), rest);
  return fmt::format("'({})'{{{}}}'{}", fmt::join(names, " "), fmt::join(names, ","), rest);
}

std::string zsh_arguments(const Command& command, const Command& program, std::string_view indent) {
  std::string text;
  std::size_t place = 0;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) ++place;
    text += fmt::format(" \\\n{}{}", indent, zsh_argument(*option, place, program));
  }
  return text;
}

/// The completion script for zsh. It is a function for $fpath, and may also be sourced after compinit.
std::string zsh_completion(const Command& program) {
  std::string commands;
  std::string cases;
  for (const Command* command : program.commands()) {
    const std::string arguments = zsh_arguments(*command, program, "            ");
    commands += fmt::format("    '{}:{}'\n", command->get_name(), escaped(command->get_description(), ":\\"));
    cases += fmt::format("        {})\n          _arguments{} ;;\n", command->get_name(), arguments);
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
      commands, zsh_arguments(program, program, "    "), cases);
}

int print_completion(const Command& program, const std::string& shell) {
  if (shell == "bash") {
    print(bash_completion(program));
  } else if (shell == "zsh") {
    print(zsh_completion(program));
  } else {
    throw InputError({}, "no completion for '" + printable(shell) + "'",
                     fmt::format("give {}", fmt::join(kShells, " or ")));
  }
  return kDone;
}

}  // namespace

Command& add_completion(Command& program) {
  Command& command =
      program.add_command("completion", "print a script with which a shell completes poesy's command line");
  const auto shell = std::make_shared<std::string>();
  command.add_value("shell", *shell, "SHELL", "bash or zsh")->required();
  command.examples = {{"in ~/.bashrc: completion in every shell", "eval \"$(poesy completion bash)\""},
                      {"the same for zsh, in a folder of $fpath", "poesy completion zsh > ~/.zfunc/_poesy"}};
  command.action = [shell, &program] { return print_completion(program, *shell); };
  return command;
}

}  // namespace poesy::app
