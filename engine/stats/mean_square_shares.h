#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/stats/linear_fit.h"
#include "engine/stats/moments.h"

namespace poesy {

/// What each error adds to the mean square of a vector, over all poses together and to first order, as a share of that
/// mean square: where errors are independent the mean squares of a linear vector add, whatever their distributions.
struct MeanSquareShares {
  std::vector<Estimate> each;  ///< [P] NaN for an error that is correlated with others
  /// The part of the scatter's mean square that is linear in the errors: the rest belongs to no error alone.
  double linear = 0.0;
};

/// What is known of an error and of its effect on a vector.
struct ErrorEffect {
  double mean_square = 1.0;  ///< mean of e^2 over the variance of e: above 1 where the error's mean is not zero
  std::size_t block = 0;     ///< the block of correlated errors that it is in, from 1; 0: it is independent
  double rounding = 0.0;     ///< an effect up to this, as a root mean square over the poses, is that of rounding
};

/// The shares of the mean square of the vector whose components at all poses are the rows `rows` of the fit.
///
/// An error adds the sum over the rows of slope^2, of which what noise adds is subtracted. Its interval takes the noise
/// of all rows as one number that they have in common, because the same machines stand at all poses, and five times the
/// variance that least squares state, because a rest that is the square of an error scatters so where the error is
/// normal (E[(z^2 - 1)^2 z^2] = 5 E[(z^2 - 1)^2] E[z^2]). So it holds the share at least as often as it says.
/// poses: how many the rows are of. errors: [P]. All shares are NaN where nothing but rounding varies.
/// Precondition: 0 < conf_level < 1.
MeanSquareShares mean_square_shares(const LinearFit& fit, std::span<const std::size_t> rows, std::size_t poses,
                                    std::span<const ErrorEffect> errors, double conf_level);

}  // namespace poesy
