#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace poesy {

/// The tables of a TOML file. Throws InputError, with the place in the file at `path`, for text that is not TOML, a
/// line longer than 16384 bytes, and a number that is not 0 but too small to be told from it. `remedy`: what to do
/// about text that is not TOML.
toml::table parse_toml(const std::string& text, const std::string& path, std::string_view remedy);

}  // namespace poesy
