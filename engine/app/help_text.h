#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

namespace poesy::app {

/// What --help prints of the program or of one command, in so many columns.
std::string help_text(const CLI::App& app, std::size_t width);

/// Columns for help on stdout.
std::size_t help_width();

}  // namespace poesy::app
