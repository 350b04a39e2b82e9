#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "engine/optimise/tolerance_limits.h"

/// Tolerances without costs: proportions, and the largest common factor that limits allow.
namespace poesy {

/// What a tolerance may be: 0 <= lo <= hi, SI; hi may be infinite.
struct ToleranceRange {
  double lo;  ///< >= 0
  double hi;  ///< >= lo
};

/// Proportions [N] of equal effect: every part alone uses the same share of the limit that it uses most,
/// T_i = 1 / sqrt(max_l a_li^2 / room_l), or 1 / max_l (|a_li| / room_l) in the worst case. Infinite for a part without
/// effect.
std::vector<double> equal_effect_proportions(const ToleranceLimits& limits);

/// Tolerances as loose as limits allow.
struct Loosest {
  std::vector<double> tolerance;     ///< [N] factor x proportion, within the ranges
  double factor;                     ///< infinite where every part is at its upper bound or has no effect
  std::optional<std::size_t> limit;  ///< that allows no larger factor
};

/// The largest factor at which T_i = factor x proportion_i, but no less than lo_i and no more than hi_i, keeps all
/// limits; in closed form, from where bounds begin to hold. A part of infinite proportion has its upper bound. Equal
/// tolerances have proportions of 1. Preconditions: proportions [N] > 0, ranges [N]; a part with effect has a finite
/// proportion.
std::variant<Loosest, CannotBeMet> as_loose_as_limits_allow(const ToleranceLimits& limits,
                                                            std::span<const double> proportions,
                                                            std::span<const ToleranceRange> ranges);

}  // namespace poesy
