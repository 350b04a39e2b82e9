#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/stats/linear_fit.h"
#include "engine/stats/moments.h"

namespace poesy {

/// The share of each error in the mean square of a vector over all poses, to first order. The mean squares of
/// independent errors add in a linear vector, whatever their distributions.
struct MeanSquareShares {
  std::vector<Estimate> each;  ///< [errors] share of each error; NaN if it is correlated with others
  /// The share of the mean square that is linear in the errors. The rest of the mean square cannot be attributed to
  /// single errors.
  double linear = 0.0;
};

/// Data of an error and of its effect on a vector.
struct ErrorEffect {
  double mean_square = 1.0;  ///< mean of e^2 over the variance of e; above 1 if the mean of e is not zero
  /// Number of the block of correlated errors to which the error belongs, from 1; 0: the error is independent.
  std::size_t block = 0;
  double rounding = 0.0;  ///< largest effect, as a root mean square over the poses, that rounding alone may give
};

/// The shares for the vector whose components at all poses are the rows `rows` of the fit.
///
/// The part of an error is the sum of slope^2 over the rows, less the bias from noise. The interval takes the noise of
/// all rows as fully correlated, because the same machines are used at all poses. It also takes five times the variance
/// of a slope that least squares give. Residuals that are the square of a normal error z need this factor: E[(z^2 -
/// 1)^2 z^2] = 5 E[(z^2 - 1)^2] E[z^2]. So the coverage is at least the level. poses: the number of poses in the rows.
/// errors: [errors]. All shares are NaN if only rounding varies. Precondition: 0 < conf_level < 1.
MeanSquareShares mean_square_shares(const LinearFit& fit, std::span<const std::size_t> rows, std::size_t poses,
                                    std::span<const ErrorEffect> errors, double conf_level);

}  // namespace poesy
