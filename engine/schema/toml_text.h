#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace poesy {

/// Parses a TOML file. Throws InputError, with the place in the file at `path`, for text that is not TOML, a line
/// longer than 16384 bytes, and a nonzero number that is too small to be distinguished from 0. remedy: advice for text
/// that is not TOML.
toml::table parse_toml(const std::string& text, const std::string& path, std::string_view remedy);

}  // namespace poesy
