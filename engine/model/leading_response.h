#pragma once

#include <cstddef>
#include <string_view>

namespace poesy {

/// The result of leading_rank() for a response that is neither the displacement of the tool nor that of the platform.
inline constexpr std::size_t kNotLeading = 2;

/// The rank of a response by importance, which decides which response leads if a study states no limit: 0 for the
/// displacement of the tool's point ("tip_position"), 1 for that of the platform's origin ("position"), kNotLeading for
/// any other response. All mechanisms use these two names.
constexpr std::size_t leading_rank(std::string_view response) {
  if (response == "tip_position") return 0;
  return response == "position" ? 1 : kNotLeading;
}

}  // namespace poesy
