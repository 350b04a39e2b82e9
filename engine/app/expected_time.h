#pragma once

#include <cstddef>

#include "engine/run/outlook.h"

namespace poesy::app {

/// The expected duration of a run on this machine, s.
struct ExpectedTime {
  double least;  ///< duration if adaptive samples end as early as possible; equal to `most` if the number of samples is
                 ///< fixed
  double most;   ///< duration with the largest number of samples
};

/// Measures the duration of pieces of the study's work on this machine, at least one piece of each sort of work. Takes
/// about `seconds` for solving, and the same time for merging. Defined in check.cpp.
ExpectedTime expected_time(const Outlook& expected, std::size_t threads, double seconds);

/// The duration in s above which the program asks before it starts a run.
inline constexpr double kLongRun = 86400.0;

}  // namespace poesy::app
