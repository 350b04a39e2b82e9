#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace poesy::app {

/// Throws InputError that names the option and both bounds unless the text is a whole number within them.
std::uint64_t parse_whole_number(const std::string& text, const std::string& option, std::uint64_t least,
                                 std::uint64_t most);

/// An option or argument of the command that is a whole number from `least` to `most`. Called `shown` in errors.
template <class Number>
CLI::Option* add_whole_number(CLI::App& command, const std::string& name, const std::string& shown, Number& number,
                              const std::string& about, std::uint64_t least, std::uint64_t most) {
  return command.add_option_function<std::string>(
      name, [=, &number](const std::string& text) { number = parse_whole_number(text, shown, least, most); }, about);
}

}  // namespace poesy::app
