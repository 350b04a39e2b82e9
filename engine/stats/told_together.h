#pragma once

#include <span>
#include <vector>

#include "engine/stats/moments.h"

namespace poesy {

/// Which of several quantities differ from zero, by Holm's steps (1979, Scand. J. Stat. 6, 65-70): with a probability
/// of conf_level none of those that are zero is told, also if the quantities depend on each other.
///
/// estimates: with intervals of skewed_mean() (yield_gradient.h) at conf_level and with this freedom; NaN: not tested
/// and not told. bounds: the least and the largest end that an interval may have; an end there was moved, and the other
/// one's distance is used. None is told if freedom < 1. Precondition: 0 < conf_level < 1.
///
/// A step needs the interval at a higher level, which follows from the one at conf_level: the difference of the
/// distances from the estimate to both ends grows with the square of Student's quantile, and so does their product. An
/// end that would move less than in proportion to the quantile is moved in proportion, which tells less.
std::vector<bool> told_together(std::span<const Estimate> estimates, const Interval& bounds, double freedom,
                                double conf_level);

}  // namespace poesy
