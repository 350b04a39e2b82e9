#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "engine/optimise/tolerance_limits.h"

/// Tolerances without costs: proportions, and the largest common factor that the limits allow.
namespace poesy {

/// The range of a tolerance, SI: 0 <= lo <= hi; hi may be infinite.
struct ToleranceRange {
  double lo;  ///< least tolerance
  double hi;  ///< largest tolerance
};

/// [N] Proportions of equal effect: every part alone uses the same share of the limit that it uses most, T_i = 1 /
/// sqrt(max_l a_li^2 / room_l). Infinite for a part without effect.
std::vector<double> equal_effect_proportions(const ToleranceLimits& limits);

/// The largest tolerances in given proportions.
struct MaxTolerances {
  std::vector<double> tolerance;     ///< [N] factor x proportion, within the ranges
  double factor;                     ///< infinite if every part is at its upper bound or has no effect
  std::optional<std::size_t> limit;  ///< the limit that allows no larger factor
};

/// The largest factor with which T_i = factor x proportion_i, moved within [lo_i, hi_i], keeps all limits. It has a
/// closed form between the factors at which bounds begin to hold. A part of infinite proportion has its upper bound.
/// Equal tolerances have proportions of 1. Preconditions: proportions [N] > 0, ranges [N]; a part with effect has a
/// finite proportion.
std::variant<MaxTolerances, Infeasible> maximise_tolerances(const ToleranceLimits& limits,
                                                            std::span<const double> proportions,
                                                            std::span<const ToleranceRange> ranges);

}  // namespace poesy
