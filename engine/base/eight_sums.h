#pragma once

#include <array>
#include <cstddef>
#include <numeric>

namespace poesy {

/// The number of partial sums. With eight, an addition need not wait for the previous one, and they fill whole vectors.
/// Value k is added to sum k mod 8 on every instruction set.
inline constexpr std::size_t kSums = 8;
using Sums = std::array<double, kSums>;  ///< A partial sum for each place in a vector.

/// The sum of all eight.
inline double total(const Sums& sums) { return std::accumulate(sums.begin(), sums.end(), 0.0); }

}  // namespace poesy
