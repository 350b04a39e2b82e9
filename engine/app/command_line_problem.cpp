#include "engine/app/command_line_problem.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "engine/app/description.h"
#include "engine/base/text.h"

namespace poesy::app {
namespace {

/// "poesy run" or "poesy"
std::string title(const DescribedCommand& command) { return command.name.empty() ? "poesy" : "poesy " + command.name; }

std::string see_help(const DescribedCommand& command) { return "see " + title(command) + " --help"; }

bool is_option(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

/// "did you mean 'run'? " where one is near, or begins like this. An option of one letter
/// is near to any other.
std::string nearest_text(const std::string& word, const std::vector<std::string>& known) {
  if (is_option(word) && word.size() == 2) return {};
  const std::vector<std::string_view> views(known.begin(), known.end());
  const auto longer = std::ranges::find_if(views, [&](std::string_view name) { return name.starts_with(word); });
  const std::string_view best = longer != views.end() ? *longer : nearest(word, views);
  return best.empty() ? std::string() : fmt::format("did you mean '{}'? ", best);
}

std::string unknown_option(const std::string& word, const DescribedCommand& command) {
  const std::string name = word.substr(0, word.find('='));
  std::vector<std::string> known;
  for (const DescribedOption& option : command.options) {
    known.insert(known.end(), option.names.begin(), option.names.end());
  }
  return fmt::format("{} has no option '{}'; {}{}", title(command), printable(name), nearest_text(name, known),
                     see_help(command));
}

/// What the command cannot do without, and was not given.
std::vector<std::string> missing(const CLI::App& app, const DescribedCommand& command) {
  const auto options = app.get_options();
  std::vector<std::string> list;
  for (std::size_t k = 0; k < options.size(); ++k) {
    if (!options[k]->get_required() || options[k]->count() != 0) continue;
    const DescribedOption& described = command.options[k];
    list.push_back(described.by_place() ? described.value : described.names.back() + " " + described.value);
  }
  return list;
}

std::string shown_name(const DescribedOption& option) { return option.by_place() ? option.value : option.names.back(); }

/// Two that do not go together.
std::optional<std::string> excluded(const CLI::App& app, const DescribedCommand& command) {
  const auto options = app.get_options();
  for (std::size_t k = 0; k < options.size(); ++k) {
    for (std::size_t other = k + 1; other < options.size(); ++other) {
      if (options[k]->count() == 0 || options[other]->count() == 0) continue;
      const auto& excludes = options[k]->get_excludes();
      if (std::ranges::find(excludes, options[other]) == excludes.end()) continue;
      return fmt::format("{} and {} do not go together; leave one out, {}", shown_name(command.options[k]),
                         shown_name(command.options[other]), see_help(command));
    }
  }
  return std::nullopt;
}

/// An option without its value, or one that is there twice.
std::optional<std::string> wrong_number_of_values(const CLI::App& app, const DescribedCommand& command,
                                                  const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) return std::nullopt;
  const auto options = app.get_options();
  for (std::size_t k = 0; k < options.size(); ++k) {
    const DescribedOption& described = command.options[k];
    if (described.by_place()) continue;
    const std::string& name = described.names.back();
    if (options[k]->count() > 1 && !described.repeated) {
      return fmt::format("{} is there {} times; give it once, {}", name, options[k]->count(), see_help(command));
    }
    if (std::string(error.what()).starts_with(name + ":")) {
      return fmt::format("{} needs a value; write {} {}, {}", name, name, described.value, see_help(command));
    }
  }
  return std::nullopt;
}

/// More things by their place than the command takes.
std::optional<std::string> too_many_by_place(const CLI::App& app, const DescribedCommand& command) {
  const auto options = app.get_options();
  for (std::size_t k = 0; k < options.size(); ++k) {
    if (!command.options[k].by_place()) continue;
    const auto most = static_cast<std::size_t>(options[k]->get_items_expected_max());
    if (options[k]->count() <= most) continue;
    return fmt::format(
        "{} takes at most {} {}, not {}; write {}, {}", title(command), most,
        options[k]->get_single_name() + (most == 1 || options[k]->get_single_name().ends_with('s') ? "" : "s"),
        options[k]->count(), synopsis(command), see_help(command));
  }
  return std::nullopt;
}

std::string problem_of_command(const CLI::App& app, const CLI::ParseError& error) {
  const DescribedCommand command = describe_command(app);
  const std::vector<std::string> extras = app.remaining();
  const auto option = std::ranges::find_if(extras, is_option);
  if (option != extras.end()) return unknown_option(*option, command);
  if (const auto problem = wrong_number_of_values(app, command, error)) return *problem;
  if (const auto problem = too_many_by_place(app, command)) return *problem;
  if (const auto problem = excluded(app, command)) return *problem;
  if (const auto list = missing(app, command); !list.empty()) {
    return fmt::format("{} needs {}; write {}, {}", title(command), fmt::join(list, " and "), synopsis(command),
                       see_help(command));
  }
  if (!extras.empty()) {
    return fmt::format("'{}' is one too many; write {}, {}", printable(extras.front()), synopsis(command),
                       see_help(command));
  }
  return fmt::format("{}; {}", error.what(), see_help(command));
}

}  // namespace

bool has_unknown_command(const CLI::App& program) {
  const std::vector<std::string> extras = program.remaining();
  return program.get_subcommands().empty() && !extras.empty() && !is_option(extras.front());
}

std::string unknown_command(const std::string& word, const CLI::App& program) {
  const DescribedProgram described = describe(program);
  std::vector<std::string> known;
  for (const DescribedCommand& command : described.commands) known.push_back(command.name);
  return fmt::format("no command '{}'; {}{}", printable(word), nearest_text(word, known), see_help(described.program));
}

std::optional<std::string> empty_value(const CLI::App& program) {
  for (const CLI::App* called : program.get_subcommands()) {
    const DescribedCommand command = describe_command(*called);
    const auto options = called->get_options();
    for (std::size_t k = 0; k < options.size(); ++k) {
      if (std::ranges::count(options[k]->results(), std::string()) == 0) continue;
      return fmt::format("{} is empty; write {}, {}", shown_name(command.options[k]), heading(command.options[k]),
                         see_help(command));
    }
  }
  return std::nullopt;
}

std::string command_line_problem(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<std::string> extras = program.remaining();
  if (!extras.empty()) {
    return is_option(extras.front()) ? unknown_option(extras.front(), describe_command(program))
                                     : unknown_command(extras.front(), program);
  }
  const auto called = program.get_subcommands();
  return called.empty() ? "no command given; see poesy --help" : problem_of_command(*called.front(), error);
}

}  // namespace poesy::app
