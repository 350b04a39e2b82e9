#pragma once

#include <cstddef>
#include <string_view>

namespace poesy {

/// The rank of a response that is neither of the tool nor of the platform.
inline constexpr std::size_t kNotLeading = 2;

/// How much a response matters where a study limits none, by the name that all mechanisms give it: 0 for the
/// displacement of the tool's point, 1 for that of the platform's origin, kNotLeading for any
/// other.
constexpr std::size_t leading_rank(std::string_view response) {
  if (response == "tip_position") return 0;
  return response == "position" ? 1 : kNotLeading;
}

}  // namespace poesy
