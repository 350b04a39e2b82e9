#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace poesy::app {

/// What is wrong with the command line that CLI11 refused, and what to do: "problem; remedy". Names the nearest command
/// or option that there is.
std::string command_line_problem(const CLI::App& program, const CLI::ParseError& error);

/// "no command 'rn'; did you mean 'run'? see poesy --help".
std::string unknown_command(const std::string& word, const CLI::App& program);

/// What is wrong with a command line that gives an option or an argument an empty text, as a script does whose variable
/// is not set; none where none does. Precondition: CLI11 took the command line.
std::optional<std::string> empty_value(const CLI::App& program);

/// Whether the command line begins with a command that does not exist.
bool has_unknown_command(const CLI::App& program);

}  // namespace poesy::app
