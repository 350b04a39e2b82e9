#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace poesy::app {

/// What is wrong with the command line that CLI11 refused, and what to do: "problem; remedy". Names the nearest command
/// or option that there is.
std::string command_line_problem(const CLI::App& program, const CLI::ParseError& error);

/// Whether the command line begins with a command that does not exist.
bool has_unknown_command(const CLI::App& program);

}  // namespace poesy::app
