#pragma once

#include <vector>

#include "engine/study/study.h"

namespace poesy {

/// What a Monte Carlo study alone asks.
struct MonteCarloOptions {
  std::vector<double> quantiles{0.05, 0.5, 0.95};  ///< shares of samples below, ascending
  Judge judge = Judge::rms;                        ///< of the limits
  double share = 0.0;                              ///< for Judge::share: of the draws at each pose
};

/// The kind of study in which all errors vary together.
extern const StudyKind kMonteCarloStudy;

}  // namespace poesy
