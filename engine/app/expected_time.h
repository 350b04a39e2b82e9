#pragma once

#include <cstddef>

#include "engine/run/outlook.h"

namespace poesy::app {

/// The expected duration of a run on this machine, s.
struct ExpectedTime {
  /// Duration if adaptive samples end as early as possible; equal to `most` if the number of samples is fixed.
  double least;
  double most;  ///< duration with the largest number of samples
};

/// The expected duration, from measuring pieces of the study's work on this machine, at least one piece of each sort of
/// work. seconds: about how long pieces of each sort of work are measured. Defined in check.cpp.
ExpectedTime expected_time(const Outlook& expected, std::size_t threads, double seconds);

/// The duration above which the program asks before it starts a run, s.
inline constexpr double kLongRun = 86400.0;

}  // namespace poesy::app
