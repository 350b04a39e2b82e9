#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// How the tolerance T on a drawing determines the distribution of the errors that share it.
namespace poesy::allocation {

/// The distribution of a part's errors within +-T. The mean may be offset by a share of T, and `sigmas` standard
/// deviations use the rest: T = shift T + sigmas sigma. So sigmas is 3 Cpk, by the definition of Cpk.
struct Spread {
  double sigmas;       ///< number of standard deviations in the tolerance T minus the shift, > 0
  double shift = 0.0;  ///< offset of the mean as a share of T; 0 <= shift < 1
};

/// The standard deviation of a part's errors about their mean, divided by T: (1 - shift) / sigmas.
double sigma_per_tolerance(const Spread& spread);

/// The mean square of a part's errors, divided by T^2: ((1 - shift) / sigmas)^2 + shift^2. The shift is treated as a
/// random offset that is positive as often as negative and independent of other parts, so mean squares add as variances
/// do. If the offsets of all parts acted in the same direction, their effects would add linearly. The total offset
/// could then be up to sqrt(number of parts) times as large.
double mean_square_per_tolerance(const Spread& spread);

/// Errors whose mean squares depend equally on the tolerance T of a part.
struct DrawnErrors {
  std::vector<std::size_t> errors;  ///< positions among the errors that the study varies
  /// What the tolerance T adds to the mean square of each error, divided by T^2. Negative for errors that become larger
  /// if T becomes finer: a finer zone of orientation leaves more of the zone of location to the middle of the feature.
  double mean_square;
};

/// A part of a drawing: the errors that depend on one tolerance.
struct DrawnPart {
  std::vector<DrawnErrors> groups;  ///< the errors; each error is in at most one group
};

/// [mean squares x parts] The effect of each part's T^2 on each mean square: the sum over the part's groups of
/// mean_square times the sum of error_effects over the group. error_effects: [mean squares x errors] the effect of the
/// variance of each error on each mean square. errors: the number of errors.
std::vector<double> part_effects(std::span<const double> error_effects, std::size_t errors,
                                 std::span<const DrawnPart> parts);

}  // namespace poesy::allocation
