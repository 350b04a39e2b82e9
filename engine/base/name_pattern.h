#pragma once

#include <string_view>

namespace poesy {

/// Whether a text is as the pattern says, in which '*' stands for any letters and '?' for one.
bool matches(std::string_view pattern, std::string_view text);

}  // namespace poesy
