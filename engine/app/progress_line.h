#pragma once

#include <cstddef>
#include <string>

#include "engine/run/runner.h"

namespace poesy::app {

/// What a line of progress says.
struct ProgressFacts {
  Progress progress;
  double rate = 0.0;      ///< solves per second, now; 0: not known yet
  std::size_t stage = 1;  ///< of a run in several stages, the size of which is known one by one
};

/// "43.2 % done, 7.21 M solves/s, 12 not converged (0.0012 %), 1 min 20 s left"
std::string plain_line(const ProgressFacts& facts);

/// The same with a bar, in at most `width` columns of one byte each. Where there is little room the bar gets shorter,
/// then the details go, and the time left last of all.
std::string live_line(const ProgressFacts& facts, std::size_t width);

}  // namespace poesy::app
