#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/optimise/cost_law.h"

/// Limits on what tolerances do together, and what a drawing says of a part: tolerances of several dimensions that are
/// one, and how a part's errors lie within its tolerance.
namespace poesy {

/// L limits on N parts: sum over the parts of effects_li size_i <= room_l, with sizes T^2, or T in the worst case.
struct ToleranceLimits {
  Stacking stacking = Stacking::root_sum_square;  ///< how effects add up
  std::size_t parts = 0;                          ///< N
  std::vector<double> effects;  ///< [L x N] >= 0: what one unit of size adds, such as a^2, or |a| in the worst case
  std::vector<double> room;     ///< [L] what there is for all parts, such as L^2 - b^2 with a background b

  std::size_t count() const { return room.size(); }                                          ///< L
  std::span<const double> row(std::size_t l) const { return {&effects[l * parts], parts}; }  ///< [N] of one limit
  /// What these tolerances [N] take of a limit.
  double need(std::size_t l, std::span<const double> tolerance) const;
};

/// The limit of which tolerances take the largest part.
struct LimitUse {
  std::size_t limit;  ///< the first one of those
  double share;       ///< need / room: above 1 the limit is broken; infinite where it has no room
};

/// Of all limits. Preconditions: there is a limit; tolerance [N] is finite.
LimitUse worst_use(const ToleranceLimits& limits, std::span<const double> tolerance);

/// Where no choice of tolerances keeps all limits: what the tightest ones need.
struct CannotBeMet {
  std::size_t limit;  ///< the worst one: with the largest need / room
  double need;        ///< of that limit, with every tolerance at its lowest bound
  double room;        ///< what that limit has
};

/// How the errors of parts lie within +-T. The mean of a part's errors is off by a share of T, the rest is for their
/// scatter: T = shift T + sigmas sigma. So sigmas is 3 Cpk, by the definition of Cpk.
struct Spread {
  double sigmas;       ///< > 0
  double shift = 0.0;  ///< 0 <= shift < 1

  /// By a process capability: Cpk = 1 is three standard deviations from the nearer limit.
  static Spread of_cpk(double cpk, double shift = 0.0) { return {3.0 * cpk, shift}; }
};

/// The standard deviation of a part's errors over its T: (1 - shift) / sigmas.
double sigma_per_tolerance(const Spread& spread);

/// The mean square of a part's errors over T^2: ((1 - shift) / sigmas)^2 + shift^2. A shift counts as an offset whose
/// sign is as often + as -, and that of one part tells nothing of another's: then mean squares add as those of scatter
/// do. Offsets that all work against the limit add as |a| does, to as much as the root of the number of parts times
/// this.
double mean_square_per_tolerance(const Spread& spread);

/// A part of a drawing: dimensions that share one tolerance.
struct DrawnPart {
  std::vector<std::size_t> factors;  ///< positions among the P errors
  Spread spread;                     ///< does not count in the worst case
};

/// The effects of parts [L x N] on limits, from those of errors [L x P]: by the square of a standard deviation, such as
/// MeanSquare::effects, or by the largest magnitude in the worst case. A part has the sum of its errors', times
/// mean_square_per_tolerance() or 1.
std::vector<double> part_effects(Stacking stacking, std::span<const double> error_effects, std::size_t errors,
                                 std::span<const DrawnPart> parts);

}  // namespace poesy
