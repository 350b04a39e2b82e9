#include "engine/app/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace poesy::app {
namespace {

std::string see_help(const CLI::App& command) { return "see " + title(command) + " --help"; }

std::string shown_name(const CLI::Option& option) {
  return option.get_positional() ? value_of(option) : names_of(option).back();
}

bool is_option(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

/// A suggestion, "did you mean 'run'? ", if a known word is similar to this word or begins with it; otherwise empty. An
/// option of one letter gets no suggestion, because all other options of one letter are equally similar.
std::string nearest_text(const std::string& word, const std::vector<std::string>& known) {
  if (is_option(word) && word.size() == 2) return {};
  const std::vector<std::string_view> views(known.begin(), known.end());
  const auto longer = std::ranges::find_if(views, [&](std::string_view name) { return name.starts_with(word); });
  const std::string_view best = longer != views.end() ? *longer : nearest(word, views);
  return best.empty() ? std::string() : fmt::format("did you mean '{}'? ", best);
}

std::string unknown_option(const std::string& word, const CLI::App& command) {
  const std::string name = word.substr(0, word.find('='));
  return fmt::format("{} has no option '{}'; {}{}", title(command), printable(name),
                     nearest_text(name, option_names(command)), see_help(command));
}

// Each of the following functions looks for one sort of mistake in the command line. It returns a message if the user
// made this mistake, otherwise none.

/// The message that a required argument is missing.
std::optional<std::string> missing(const CLI::App& command) {
  std::vector<std::string> list;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_required() || option->count() != 0) continue;
    list.push_back(option->get_positional() ? value_of(*option) : shown_name(*option) + " " + value_of(*option));
  }
  if (list.empty()) return std::nullopt;
  return fmt::format("{} needs {}; write {}, {}", title(command), fmt::join(list, " and "), synopsis(command),
                     see_help(command));
}

/// The message that two options exclude each other.
std::optional<std::string> excluded(const CLI::App& command) {
  for (const CLI::Option* one : command.get_options()) {
    for (const CLI::Option* other : one->get_excludes()) {
      if (one->count() == 0 || other->count() == 0) continue;
      return fmt::format("{} and {} do not go together; leave one out, {}", shown_name(*one), shown_name(*other),
                         see_help(command));
    }
  }
  return std::nullopt;
}

/// The message that an option has no value, or is given twice.
std::optional<std::string> wrong_number_of_values(const CLI::App& command, const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) return std::nullopt;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) continue;
    const std::string name = shown_name(*option);
    if (option->count() > 1 && !is_repeated(*option)) {
      return fmt::format("{} is there {} times; give it once, {}", name, option->count(), see_help(command));
    }
    if (std::string(error.what()).starts_with(name + ":")) {
      return fmt::format("{} needs a value; write {} {}, {}", name, name, value_of(*option), see_help(command));
    }
  }
  return std::nullopt;
}

/// The message that there are more positional arguments than the command takes.
std::optional<std::string> too_many_by_place(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const auto most = static_cast<std::size_t>(option->get_items_expected_max());
    if (option->count() <= most) continue;
    const std::string name = option->get_single_name();
    return fmt::format("{} takes at most {} {}, not {}; write {}, {}", title(command), most,
                       name + (most == 1 || name.ends_with('s') ? "" : "s"), option->count(), synopsis(command),
                       see_help(command));
  }
  return std::nullopt;
}

std::string problem_of_command(const CLI::App& command, const CLI::ParseError& error) {
  const std::vector<std::string> extras = command.remaining();
  const auto option = std::ranges::find_if(extras, is_option);
  if (option != extras.end()) return unknown_option(*option, command);
  if (const auto problem = wrong_number_of_values(command, error)) return *problem;
  if (const auto problem = too_many_by_place(command)) return *problem;
  if (const auto problem = excluded(command)) return *problem;
  if (const auto problem = missing(command)) return *problem;
  if (!extras.empty()) {
    return fmt::format("'{}' is one too many; write {}, {}", printable(extras.front()), synopsis(command),
                       see_help(command));
  }
  return fmt::format("{}; {}", error.what(), see_help(command));
}

}  // namespace

Command& Command::add_command(const std::string& name, const std::string& about) {
  const auto command = std::make_shared<Command>(name, about, this);
  add_subcommand(command);
  return *command;
}

std::vector<const Command*> Command::commands() const {
  std::vector<const Command*> list;
  for (const CLI::App* command : get_subcommands([](const CLI::App*) { return true; })) {
    list.push_back(dynamic_cast<const Command*>(command));
  }
  return list;
}

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

std::uint64_t parse_whole_number(const std::string& text, const std::string& option, std::uint64_t least,
                                 std::uint64_t most) {
  const auto number = whole_number(text);
  if (number && *number >= least && *number <= most) return *number;
  throw InputError({}, fmt::format("{} is '{}'", option, printable(text)),
                   fmt::format("give a whole number from {} to {}", least, most));
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    std::ranges::copy(names_of(*option), std::back_inserter(names));
  }
  return names;
}

std::string value_of(const CLI::Option& option) {
  return option.get_items_expected_max() != 0 ? option.get_type_name() : std::string();
}

bool is_repeated(const CLI::Option& option) { return option.get_expected_max() > 1; }

std::string heading(const CLI::Option& option) {
  const std::string value = value_of(option);
  std::string text = fmt::format("{}", fmt::join(names_of(option), ", "));
  if (!value.empty()) text += (text.empty() ? "" : " ") + value;
  return is_repeated(option) ? text + " ..." : text;
}

std::string title(const CLI::App& command) {
  return command.get_parent() == nullptr ? "poesy" : "poesy " + command.get_name();
}

std::string synopsis(const CLI::App& command) {
  if (command.get_parent() == nullptr) return "poesy COMMAND [arguments] [options]";
  std::string by_place;
  std::string by_name;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) {
      by_place += option->get_required() ? " " + heading(*option) : " [" + heading(*option) + "]";
    } else if (option->get_required()) {
      by_name += " " + names_of(*option).front() + " " + value_of(*option);
    }
  }
  return title(command) + by_place + by_name + " [options]";
}

bool has_unknown_command(const Command& program) {
  const std::vector<std::string> extras = program.remaining();
  return program.get_subcommands().empty() && !extras.empty() && !is_option(extras.front());
}

std::string unknown_command(const std::string& word, const Command& program) {
  std::vector<std::string> known;
  for (const Command* command : program.commands()) known.push_back(command->get_name());
  return fmt::format("no command '{}'; {}{}", printable(word), nearest_text(word, known), see_help(program));
}

std::optional<std::string> impossible_value(const Command& program) {
  for (const CLI::App* command : program.get_subcommands()) {
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& value : option->results()) {
        const bool is_name = !option->get_positional() && value.starts_with("--");
        if (!value.empty() && !is_name) continue;
        const std::string problem =
            value.empty() ? "is empty" : "has the option '" + printable(value) + "' for its value";
        return fmt::format("{} {}; write {}, {}", shown_name(*option), problem, heading(*option), see_help(*command));
      }
    }
  }
  return std::nullopt;
}

std::string command_line_problem(const Command& program, const CLI::ParseError& error) {
  const std::vector<std::string> extras = program.remaining();
  if (!extras.empty()) {
    return is_option(extras.front()) ? unknown_option(extras.front(), program)
                                     : unknown_command(extras.front(), program);
  }
  const auto called = program.get_subcommands();
  return called.empty() ? "no command given; see poesy --help" : problem_of_command(*called.front(), error);
}

}  // namespace poesy::app
