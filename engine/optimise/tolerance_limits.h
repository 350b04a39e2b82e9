#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/optimise/cost_law.h"

/// Limits on the combined effect of the tolerances of all parts.
namespace poesy {

/// L linear constraints on the sizes of N parts: sum over the parts of effects_li size_i <= room_l. A size is T^2, or T
/// in the worst case.
struct ToleranceLimits {
  Stacking stacking = Stacking::root_sum_square;  ///< how effects add up
  std::size_t parts = 0;                          ///< N
  /// [L x N] effect of one unit of size, such as a^2, or |a| in the worst case; >= 0, except for inner parts (Within)
  std::vector<double> effects;
  std::vector<double> room;  ///< [L] the largest combined effect of all parts

  std::size_t count() const { return room.size(); }  ///< L
  std::span<const double> row(std::size_t l) const {
    return {&effects[l * parts], parts};
  }  ///< [N] effects on one limit
  /// The combined effect of these tolerances [N] on a limit.
  double need(std::size_t l, std::span<const double> tolerance) const;
};

/// The use of one limit.
struct LimitUse {
  std::size_t limit;  ///< position of the limit
  double share;       ///< need / room: above 1 the limit is broken; infinite if it has no room
};

/// The use of the limit that is used most, the first of equal ones. Preconditions: there is a limit; tolerance [N] is
/// finite.
LimitUse worst_use(const ToleranceLimits& limits, std::span<const double> tolerance);

/// A problem without a feasible point: even the lowest tolerances break a limit.
struct Infeasible {
  std::size_t limit;  ///< the limit with the largest need / room
  double need;        ///< combined effect of the lowest tolerances
  double room;        ///< room of the limit
};

}  // namespace poesy
