#pragma once

#include <cstddef>

#include "engine/run/outlook.h"

namespace poesy::app {

/// The expected duration of a run, s.
struct ExpectedTime {
  double least;  ///< time for the samples that adaptive samples take in any case; else the same as `most`
  double most;   ///< time for the largest number of samples
};

/// Times pieces of the study on this machine, at least one of each work, for about this many seconds of solving and as
/// many of merging. (check.cpp)
ExpectedTime expected_time(const Outlook& expected, std::size_t threads, double seconds);

/// Before a run that takes longer, the program asks whether it is meant, s.
inline constexpr double kLongRun = 86400.0;

}  // namespace poesy::app
