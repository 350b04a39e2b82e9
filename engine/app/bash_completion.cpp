#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/app/shell_scripts.h"

namespace poesy::app {
namespace {

constexpr std::string_view kBegin = R"(# bash completion for poesy, written by 'poesy completion bash'

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

constexpr std::string_view kEnd = R"(
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

/// What _poesy acts on.
std::string value_text(const Offer& offer) {
  switch (offer.kind) {
    case Offer::Kind::words:
      return fmt::format("words {}", fmt::join(offer.words, " "));
    case Offer::Kind::files:
      return "files " + offer.extension;
    case Offer::Kind::folders:
      return "folders";
    case Offer::Kind::nothing:
      break;
  }
  return "nothing";
}

std::string values_of(const DescribedCommand& command) {
  std::string text;
  std::size_t place = 0;
  for (const DescribedOption& option : command.options) {
    if (option.value.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) patterns.push_back(fmt::format("'{} {}'", command.name, name));
    if (option.by_place()) {
      patterns.push_back(option.repeated ? fmt::format("'{} '[0-9]*", command.name)
                                         : fmt::format("'{} {}'", command.name, ++place));
    }
    text += fmt::format("    {}) value='{}' ;;\n", fmt::join(patterns, " | "), value_text(option.offer));
  }
  return text;
}

std::string options_of(const DescribedCommand& command) {
  std::vector<std::string> names;
  for (const DescribedOption& option : command.options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return fmt::format("    '{}') value='words {}' ;;\n", command.name, fmt::join(names, " "));
}

}  // namespace

std::string bash_completion(const DescribedProgram& described) {
  std::string names;
  std::string values;
  std::string options = options_of(described.program);
  for (const DescribedCommand& command : described.commands) {
    names += (names.empty() ? "" : " ") + command.name;
    values += values_of(command);
    options += options_of(command);
  }
  return fmt::format(
      "{}_poesy_commands='{}'\n\n"
      "# Sets value: what stands after an option, or at a place. Fails where nothing does.\n"
      "_poesy_value() {{\n  value=\n  case $1 in\n{}    *) return 1 ;;\n  esac\n}}\n\n"
      "# Sets value: the options of a command, or of the program.\n"
      "_poesy_options() {{\n  value=\n  case $1 in\n{}  esac\n}}\n{}",
      kBegin, names, values, options, kEnd);
}

}  // namespace poesy::app
