#pragma once

#include <array>
#include <cstddef>
#include <numeric>

namespace poesy {

/// Eight sums, so that an addition need not wait for the one before, and that they make whole vectors. Value k goes to
/// sum k mod 8 on every instruction set.
inline constexpr std::size_t kSums = 8;
using Sums = std::array<double, kSums>;  ///< One for each place in a vector.

/// All eight together.
inline double total(const Sums& sums) { return std::accumulate(sums.begin(), sums.end(), 0.0); }

}  // namespace poesy
