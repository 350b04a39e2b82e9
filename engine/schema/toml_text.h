#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace poesy {

/// Parses a TOML file. path: name of the file in messages. remedy: advice for text that is not TOML. Throws InputError
/// at the place in the file for text that is not TOML, a line longer than 16384 bytes, and a nonzero number that is too
/// small to be distinguished from 0.
toml::table parse_toml(const std::string& text, const std::string& path, std::string_view remedy);

}  // namespace poesy
