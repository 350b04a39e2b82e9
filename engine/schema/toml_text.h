#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace poesy {

/// Parses a TOML file. path: name of the file in messages. remedy: advice for text that is not TOML. Throws InputError
/// at the place of the mistake for text that is not TOML, for a line longer than 16384 bytes, and for a nonzero number
/// so small that the TOML library reads it as 0.
toml::table parse_toml(const std::string& text, const std::string& path, std::string_view remedy);

}  // namespace poesy
