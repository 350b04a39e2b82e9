#pragma once

#include <cstddef>

#include "engine/run/outlook.h"

namespace poesy::app {

/// How long a run will take, s.
struct ExpectedTime {
  double least;  ///< with adaptive samples what is solved in any case
  double most;   ///< the same without them
};

/// Tries pieces of the study on this machine, at least one of each work, for about so many seconds for solving and as
/// many for merging. (check.cpp)
ExpectedTime expected_time(const Outlook& expected, std::size_t threads, double seconds);

/// A run that takes longer is asked about before it starts, s.
inline constexpr double kLongRun = 86400.0;

}  // namespace poesy::app
