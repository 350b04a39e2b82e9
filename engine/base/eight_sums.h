#pragma once

#include <array>
#include <cstddef>
#include <numeric>

namespace poesy {

/// The number of partial sums of a total. With eight of them, an addition need not wait for the previous one, and they
/// fill whole vector registers. Value k is added to sum k mod 8 on every instruction set.
inline constexpr std::size_t kSums = 8;
using Sums = std::array<double, kSums>;  ///< Eight partial sums of one total.

/// The sum of the eight partial sums.
inline double total(const Sums& sums) { return std::accumulate(sums.begin(), sums.end(), 0.0); }

}  // namespace poesy
