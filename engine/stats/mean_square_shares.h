#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/stats/linear_fit.h"
#include "engine/stats/moments.h"

namespace poesy {

/// The share of each error in the scatter of a vector, to first order. The scatter is the mean square of the vector
/// about its mean over the machines, summed over all poses. If the vector is linear in independent errors, their parts
/// of the scatter add, whatever their distributions. Their parts of the mean may cancel each other, so the square of
/// the vector's mean is not divided among errors.
struct MeanSquareShares {
  std::vector<Estimate> each;  ///< [errors] share of each error in the scatter; NaN if it is correlated with others
  /// The share of the scatter that is linear in the errors. The rest of the scatter cannot be attributed to single
  /// errors.
  double linear = 0.0;
  double offset = 0.0;        ///< root mean square over the poses of the vector's mean, in the vector's unit
  double offset_share = 0.0;  ///< squared mean over the whole mean square (squared mean plus scatter)
};

/// Data of an error and of its effect on a vector.
struct ErrorEffect {
  /// Number of the block of correlated errors to which the error belongs, from 1; 0: the error is independent.
  std::size_t block = 0;
  /// Value up to which the root mean square of the effect over the poses may be rounding, in the vector's unit.
  double rounding = 0.0;
};

/// The shares for the vector whose components at all poses are the rows `rows` of the fit.
///
/// The part of an error is the sum of slope^2 over the rows, less the bias from noise. The interval takes the noise of
/// all rows as fully correlated, because the same machines are used at all poses. The interval is computed with five
/// times the least-squares variance of each slope. This factor is correct for residuals that are the square of a normal
/// error z, because E[(z^2 - 1)^2 z^2] = 5 E[(z^2 - 1)^2] E[z^2]. For residuals that do not depend on the error the
/// interval is too wide. If some errors are correlated, intervals are NaN, because they would leave out the noise of
/// the correlation, which is estimated from the machines of the fit. poses: the number of poses in the rows. errors:
/// [errors]. All results are NaN if no error has an effect above its `rounding`. Precondition: 0 < conf_level < 1.
MeanSquareShares mean_square_shares(const LinearFit& fit, std::span<const std::size_t> rows, std::size_t poses,
                                    std::span<const ErrorEffect> errors, double conf_level);

}  // namespace poesy
