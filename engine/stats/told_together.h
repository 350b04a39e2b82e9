#pragma once

#include <span>
#include <vector>

#include "engine/stats/moments.h"

namespace poesy {

/// Finds which of several quantities are shown to differ from zero, by Holm's steps (1979, Scand. J. Stat. 6, 65-70);
/// the result is true for these quantities. With a probability of at least conf_level, the result is false for every
/// quantity that is zero, even if the estimates are correlated.
///
/// estimates: with intervals of skewed_mean() (yield_gradient.h) at conf_level and with these degrees of freedom. The
/// result is false for an estimate with a NaN. bounds: the range to which the ends of all intervals were limited
/// (within() in yield_gradient.h). If an end is at its bound, its distance from the estimate is replaced by that of the
/// other end. The result is false for all if freedom < 1. zero_sd: [quantities] the standard deviation that an estimate
/// would have if the quantity were zero; 0 if it is not known. Precondition: 0 < conf_level < 1.
///
/// An interval follows from the spread of the few numbers that enter an estimate, which by chance may all be near each
/// other and far from zero. So the result is also false if the estimate is within Student's quantile times zero_sd of
/// zero.
///
/// A step needs the interval at a higher level, which follows from the one at conf_level: the difference of the
/// distances from the estimate to both ends grows with the square of Student's quantile, and so does their product. An
/// end that would move by less than in proportion to the quantile is moved in proportion. This makes the interval
/// wider, so the result is true for fewer quantities.
std::vector<bool> told_together(std::span<const Estimate> estimates, const Interval& bounds, double freedom,
                                std::span<const double> zero_sd, double conf_level);

}  // namespace poesy
