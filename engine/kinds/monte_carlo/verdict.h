#pragma once

#include <span>

#include "engine/kinds/monte_carlo/result.h"
#include "engine/stats/quantile_sketch.h"
#include "engine/study/study.h"

namespace poesy {

/// Judges the limits of a Monte Carlo study by what it found. A limit is kept
/// - by Judge::rms, if the response's root mean square over the samples of all poses that count is within it;
/// - by Judge::share, if at every pose at least that share of all draws is within it: if the largest of the poses'
///   share_magnitude is. Draws that do not count are not within it.
/// overall: [R], the samples of all poses that count. Numbers from a sketch are off by its kRelativeError at most.
/// Precondition: found.overall_rms is there, and found.share_magnitude where it is needed.
LimitVerdicts judge_draws(std::span<const ResponseLimit> limits, Judge judge, double share,
                          const MonteCarloResult& found, std::span<const QuantileSketch> overall);

}  // namespace poesy
