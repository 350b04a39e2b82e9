#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/optimise/cost_law.h"

/// Limits on the combined effect of the tolerances of all parts.
namespace poesy {

/// L linear constraints on the sizes of N parts: for each limit l, the sum over the parts i of effects_li size_i is at
/// most room_l. The size of a tolerance T is T^2, or T for Stacking::worst_case (cost_law.h).
struct ToleranceLimits {
  Stacking stacking = Stacking::root_sum_square;  ///< how effects add up
  std::size_t parts = 0;                          ///< N, the number of parts
  /// [limits x parts] Effect on each limit per unit of each part's size: a^2, or |a| for Stacking::worst_case, if a
  /// tolerance T has the effect a T. Not negative, except for the inner parts of pairs (Within in least_cost.h).
  std::vector<double> effects;
  std::vector<double> room;  ///< [limits] the largest combined effect of all parts that keeps the limit

  std::size_t count() const { return room.size(); }  ///< L, the number of limits.
  /// [parts] The effects of all parts on limit l.
  std::span<const double> row(std::size_t l) const { return {&effects[l * parts], parts}; }
  /// The combined effect of tolerances [parts] (SI) on limit l.
  double need(std::size_t l, std::span<const double> tolerance) const;
};

/// The share of a limit's room (ToleranceLimits::room) that some tolerances use.
struct LimitUse {
  std::size_t limit;  ///< position of the limit
  double share;  ///< combined effect of the tolerances / room of the limit; above 1 the limit is broken; infinite if
                 ///< the room is not positive
};

/// The limit of which the largest share is used; the first one if several are equal. Preconditions: there is at least
/// one limit; tolerance [parts] is finite.
LimitUse worst_use(const ToleranceLimits& limits, std::span<const double> tolerance);

/// A problem without a feasible point: even the lowest tolerances break a limit.
struct Infeasible {
  std::size_t limit;  ///< position of the limit of which the lowest tolerances use the largest share (LimitUse)
  double need;        ///< combined effect of the lowest tolerances on this limit
  double room;        ///< room of the limit
};

}  // namespace poesy
