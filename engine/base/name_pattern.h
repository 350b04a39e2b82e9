#pragma once

#include <string_view>

namespace poesy {

/// Whether a text matches a pattern, in which '*' matches any characters and '?' one.
bool matches(std::string_view pattern, std::string_view text);

}  // namespace poesy
