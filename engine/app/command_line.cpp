#include "engine/app/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace poesy::app {

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

std::uint64_t parse_whole_number(const std::string& text, const std::string& option, std::uint64_t least,
                                 std::uint64_t most) {
  std::uint64_t number = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, number);
  if (error == std::errc() && end == last && number >= least && number <= most) return number;
  throw InputError({}, fmt::format("{} is '{}'", option, printable(text)),
                   fmt::format("give a whole number from {} to {}", least, most));
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
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

std::string synopsis(const CLI::App& command) {
  std::string by_place;
  std::string by_name;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) {
      by_place += option->get_required() ? " " + heading(*option) : " [" + heading(*option) + "]";
    } else if (option->get_required()) {
      by_name += " " + names_of(*option).front() + " " + value_of(*option);
    }
  }
  return "poesy " + command.get_name() + by_place + by_name + " [options]";
}

std::span<const Entry> exit_codes() {
  static constexpr std::array kEntries{
      Entry{"0", "done"},
      Entry{"1", "internal error; please report it"},
      Entry{"2", "bad command line, study or data; nothing is written"},
      Entry{"3", "a file cannot be read, written or trusted"},
      Entry{"4", "interrupted: poesy run goes on with --resume, poesy evaluate wrote nothing"},
      Entry{"5", "done and the result kept, but more samples failed to converge than the study allows"},
      Entry{"6", "done and the result kept, but a limit that the study states is not kept; 5 goes before it"}};
  return kEntries;
}

std::span<const Entry> files() {
  static constexpr std::array kEntries{
      Entry{"STUDY.toml", "what to compute; poesy template writes one to start from"},
      Entry{"RESULT.h5", "what was found; HDF5, whole or absent"},
      Entry{"RESULT.h5.part", "checkpoint of a run; the one before it is RESULT.h5.part.1"},
      Entry{"RESULT.h5.lock", "there while a run writes to this result"}};
  return kEntries;
}

std::span<const Entry> environment() {
  static constexpr std::array kEntries{
      Entry{"NO_COLOR", "if it is set and not empty, nothing is coloured"},
      Entry{"TERM", "if it is unset or 'dumb', nothing is coloured, and progress comes line by line"},
      Entry{"POESY_ISA", "instruction set of the kernels, instead of the best that the processor has"}};
  return kEntries;
}

}  // namespace poesy::app
