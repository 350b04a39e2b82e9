#pragma once

#include <cstddef>

#include "engine/run/outlook.h"

namespace poesy::app {

/// The expected duration of a run on this machine, s.
struct ExpectedTime {
  /// Duration if adaptive sampling ends as early as possible; equal to `most` if the number of samples is fixed.
  double least;
  double most;  ///< duration with the largest number of samples
};

/// The expected duration of a run. It is measured on pieces of the study's work: for each sort of work (Outlook), at
/// least one piece is done. threads: number of threads of the run. seconds: time (s) after which no more pieces of a
/// sort are begun. Defined in check.cpp.
ExpectedTime expected_time(const Outlook& expected, std::size_t threads, double seconds);

/// The duration above which the program asks before it starts a run, s.
inline constexpr double kLongRun = 86400.0;

}  // namespace poesy::app
