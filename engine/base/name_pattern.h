#pragma once

#include <string_view>

namespace poesy {

/// Returns true if a text matches a pattern. In the pattern, '*' matches any number of characters, and '?' matches one
/// character.
bool matches(std::string_view pattern, std::string_view text);

/// Returns true if a text contains '*' or '?', so that it may match several names.
inline bool is_pattern(std::string_view text) { return text.find_first_of("*?") != std::string_view::npos; }

}  // namespace poesy
