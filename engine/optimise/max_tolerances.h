#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "engine/optimise/tolerance_limits.h"

/// Tolerances without costs: given proportions, times the largest common factor that the limits allow.
namespace poesy {

/// The range of a tolerance, SI: 0 <= lo <= hi; hi may be infinite.
struct ToleranceRange {
  double lo;  ///< least tolerance, SI
  double hi;  ///< largest tolerance, SI
};

/// [parts] Proportions of tolerances of equal effect. With its tolerance T_i, each part would use up the limit that it
/// affects most, if it were the only part: T_i = 1 / sqrt(e_i), or 1 / e_i for Stacking::worst_case, with e_i the
/// largest effect / room (ToleranceLimits) of part i over the limits. Infinite for a part without effect.
std::vector<double> equal_effect_proportions(const ToleranceLimits& limits);

/// The largest tolerances in given proportions.
struct MaxTolerances {
  std::vector<double> tolerance;  ///< [parts] factor x proportion, within the ranges
  double factor;                  ///< the common factor; infinite if every part is at its upper bound or has no effect
  /// Position of the limit that prevents a larger factor; none if the factor is infinite.
  std::optional<std::size_t> limit;
};

/// Finds the largest factor for which T_i = factor x proportion_i, clamped to [lo_i, hi_i], keeps all limits. Between
/// two neighbouring factors at which some part reaches or leaves a bound, the largest factor has a closed form. A part
/// of infinite proportion gets its upper bound. Proportions of 1 give equal tolerances. Preconditions: proportions
/// [parts] > 0; ranges [parts]; the proportion of a part with effect is finite.
std::variant<MaxTolerances, Infeasible> maximise_tolerances(const ToleranceLimits& limits,
                                                            std::span<const double> proportions,
                                                            std::span<const ToleranceRange> ranges);

}  // namespace poesy
