#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// How the tolerance on a drawing determines the distribution of the errors that share it.
namespace poesy {

/// How the errors of a part are distributed within +-T: the mean is off by a share of T, and the scatter uses the rest,
/// T = shift T + sigmas sigma. So sigmas is 3 Cpk, by the definition of Cpk.
struct Spread {
  double sigmas;       ///< > 0
  double shift = 0.0;  ///< 0 <= shift < 1
};

/// The standard deviation of a part's errors divided by its T: (1 - shift) / sigmas.
double sigma_per_tolerance(const Spread& spread);

/// The mean square of a part's errors divided by T^2: ((1 - shift) / sigmas)^2 + shift^2. A shift counts as an offset
/// that is as often positive as negative and independent of the offsets of other parts, so mean squares add as
/// variances do. If all offsets worked against the limit, their effects would add linearly, to at most sqrt(parts)
/// times this.
double mean_square_per_tolerance(const Spread& spread);

/// Errors whose mean squares grow alike with the tolerance of a part.
struct DrawnErrors {
  std::vector<std::size_t> errors;  ///< positions among the P errors
  /// The mean square of each per unit of T^2; negative for errors to which a finer tolerance leaves more, as a zone of
  /// orientation does to the middle of its feature.
  double mean_square;
};

/// A part of a drawing: the errors that depend on one tolerance.
struct DrawnPart {
  std::vector<DrawnErrors> groups;  ///< the errors, an error once at most
};

/// What one unit of T^2 of each part adds to each mean square, [L x N]: the sum over its groups of mean_square times
/// the sum of error_effects over their errors. error_effects: [L x P] what one unit of each error's variance adds.
std::vector<double> part_effects(std::span<const double> error_effects, std::size_t errors,
                                 std::span<const DrawnPart> parts);

}  // namespace poesy
