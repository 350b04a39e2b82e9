#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace poesy {

/// The text with a to z for A to Z, in any locale. Other characters stay as they are.
inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return lower;
}

}  // namespace poesy
