#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/optimise/cost_law.h"

/// Limits on what the tolerances of all parts do together.
namespace poesy {

/// L linear constraints on the sizes of N parts: sum over the parts of effects_li size_i <= room_l. A size is T^2, or T
/// in the worst case.
struct ToleranceLimits {
  Stacking stacking = Stacking::root_sum_square;  ///< how effects add up
  std::size_t parts = 0;                          ///< N
  std::vector<double> effects;  ///< [L x N] >= 0: what one unit of size adds, such as a^2, or |a| in the worst case
  std::vector<double> room;     ///< [L] what all parts may take together

  std::size_t count() const { return room.size(); }                                          ///< L
  std::span<const double> row(std::size_t l) const { return {&effects[l * parts], parts}; }  ///< [N] of one limit
  /// What these tolerances [N] take of a limit.
  double need(std::size_t l, std::span<const double> tolerance) const;
};

/// How much of one limit is used.
struct LimitUse {
  std::size_t limit;  ///< position of the limit
  double share;       ///< need / room: above 1 the limit is broken; infinite where it has no room
};

/// The use of the limit that is used most; of equal ones that of the first. Preconditions: there is a limit; tolerance
/// [N] is finite.
LimitUse worst_use(const ToleranceLimits& limits, std::span<const double> tolerance);

/// A problem without a feasible point: even the lowest tolerances break a limit.
struct Infeasible {
  std::size_t limit;  ///< the limit with the largest need / room
  double need;        ///< what the lowest tolerances take of it
  double room;        ///< what it has
};

}  // namespace poesy
