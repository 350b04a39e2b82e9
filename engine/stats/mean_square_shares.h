#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/stats/linear_fit.h"
#include "engine/stats/moments.h"

namespace poesy {

/// The share of each error in the mean square of a vector, to first order and over all poses together. The mean squares
/// of independent errors add in a linear vector, whatever their distributions.
struct MeanSquareShares {
  std::vector<Estimate> each;  ///< [P] NaN for an error that is correlated with others
  /// The share of the scatter's mean square that is linear in the errors; the rest belongs to no single error.
  double linear = 0.0;
};

/// Data of an error and of its effect on a vector.
struct ErrorEffect {
  double mean_square = 1.0;  ///< mean of e^2 over the variance of e; above 1 if the mean of e is not zero
  std::size_t block = 0;     ///< the block of correlated errors, counted from 1; 0: the error is independent
  double rounding = 0.0;     ///< largest effect, as a root mean square over the poses, that is rounding
};

/// The shares for the vector whose components at all poses are the rows `rows` of the fit.
///
/// The part of an error is the sum of slope^2 over the rows, less the bias from noise. The interval takes the noise of
/// all rows as fully correlated, because the same machines are used at all poses. It also takes five times the variance
/// that least squares state, because residuals that are the square of a normal error scatter so: E[(z^2 - 1)^2 z^2] = 5
/// E[(z^2 - 1)^2] E[z^2]. So its coverage is at least its level. poses: the number of poses in the rows. errors: [P].
/// All shares are NaN if only rounding varies. Precondition: 0 < conf_level < 1.
MeanSquareShares mean_square_shares(const LinearFit& fit, std::span<const std::size_t> rows, std::size_t poses,
                                    std::span<const ErrorEffect> errors, double conf_level);

}  // namespace poesy
