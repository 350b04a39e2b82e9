#pragma once

#include <string_view>

namespace poesy {

/// Whether a text matches a pattern, in which '*' matches any characters and '?' one.
bool matches(std::string_view pattern, std::string_view text);

/// Whether a text has one of these two, so that it may match several names.
inline bool is_pattern(std::string_view text) { return text.find_first_of("*?") != std::string_view::npos; }

}  // namespace poesy
