#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// What a tolerance on a drawing says of the errors that share it.
namespace poesy {

/// How the errors of a part lie within +-T: their mean is off by a share of T, and their scatter takes the rest, T =
/// shift T + sigmas sigma. So sigmas is 3 Cpk, by the definition of Cpk.
struct Spread {
  double sigmas;       ///< > 0
  double shift = 0.0;  ///< 0 <= shift < 1
};

/// The standard deviation of a part's errors over its T: (1 - shift) / sigmas.
double sigma_per_tolerance(const Spread& spread);

/// The mean square of a part's errors over T^2: ((1 - shift) / sigmas)^2 + shift^2. A shift counts as an offset that is
/// as often positive as negative and independent of those of other parts, so that mean squares add as variances do.
/// Offsets that all work against the limit would add as |a| does, to as much as the root of the number of parts times
/// this.
double mean_square_per_tolerance(const Spread& spread);

/// A part of a drawing: dimensions that share one tolerance.
struct DrawnPart {
  std::vector<std::size_t> factors;  ///< positions among the P errors
  Spread spread;                     ///< how each of its errors lies within the tolerance
};

/// What one unit of T^2 of each part adds to each mean square [L x N]: from what the variance of each error adds [L x
/// P] the sum over the part's errors, times mean_square_per_tolerance().
std::vector<double> part_effects(std::span<const double> error_effects, std::size_t errors,
                                 std::span<const DrawnPart> parts);

}  // namespace poesy
