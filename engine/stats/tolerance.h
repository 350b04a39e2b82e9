#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/units.h"
#include "engine/stats/indices.h"

/// Tolerances from the indices of a sensitivity study. A tolerance here is the standard deviation of a normal error, in
/// SI; infinity says that the error has no effect on its own, NaN that its effect is not known.
namespace poesy {

/// One response of a sensitivity study of P errors at M poses, SI. Refers to the study's arrays.
struct ResponseStudy {
  /// A number of each error at each pose.
  template <class T>
  using Cells = ArrayView<const T, axis::Factor, axis::Pose>;

  std::vector<double> index;           ///< [P] global, as far as it can be told from rounding (stats/indices.h)
  std::span<const double> sigma;       ///< [P] of the errors, as the study sets them
  Cells<std::uint64_t> count;          ///< samples
  Cells<double> mean;                  ///< of the response, one error varying
  Cells<double> std;                   ///< standard deviation, likewise
  std::span<const double> background;  ///< [M] the response with all varied errors zero
};

/// The error from which equal-effect tolerances are counted.
struct ReferenceError {
  std::size_t factor;  ///< position among the P errors
  double tolerance;    ///< SI
};

/// The error with the smallest effect index x sigma of those that have one; none where no error has.
std::optional<std::size_t> smallest_effect(std::span<const double> index, std::span<const double> sigma);

/// t_p = (mu_ref / mu_p) t_ref: what gives every error the effect of the reference (Du et al. 2022, Section 6.3, Table
/// 10), [P]. NaN throughout when the reference has no effect.
std::vector<double> equal_effect_tolerances(std::span<const double> index, const ReferenceError& reference);

/// The mean square of a response over the poses, for independent errors of mean zero and standard deviations t_p:
/// background + sum of effects_p t_p^2. Exact for a response that is linear in the errors or the norm of something
/// linear; for others see Response::mean_square_bound. Its root is never below the mean of the response (Jensen).
struct MeanSquare {
  double background = 0.0;      ///< mean square over the poses of the response to the background alone
  std::vector<double> effects;  ///< [P] growth of the mean square per t_p^2; 0 for errors without effect

  /// sum of effects_p t_p^2. Errors without effect do not count, whatever their tolerance.
  double growth(std::span<const double> tolerances) const;
  /// The same where these errors, by position, always have these sizes [P]: what they add is part of the background.
  MeanSquare holding(std::span<const std::size_t> errors, std::span<const double> sizes) const;
  /// The mean square with these tolerances [P].
  double at(std::span<const double> tolerances) const { return background + growth(tolerances); }
};

/// From the study's own samples: effects_p = mean over the poses of (mean square of the samples - background^2),
/// or 0 if that is negative, over sigma_p^2. NaN where a pose has no background, or fewer than two samples of an error,
/// or where an index is not known.
MeanSquare mean_square(const ResponseStudy& study);

/// effects_p sigma_p^2 over its sum, [P]: the error's share of what all errors of these standard deviations add to the
/// mean square. NaN throughout where an effect is not known or no error has one.
std::vector<double> mean_square_shares(const MeanSquare& response, std::span<const double> sigma);

/// The multiple of `proportions` [P] whose predicted mean square is limit^2; proportions that are infinite stay so. No
/// tolerance of an error with effect is larger than largest [P] says: what such an error leaves of the limit the others
/// share. NaN where the prediction is not known. Precondition: limit^2 > background.
std::vector<double> tolerances_within(const MeanSquare& response, std::span<const double> proportions, double limit,
                                      std::span<const double> largest);

/// Tolerances of all errors for one response.
struct Tolerances {
  std::optional<ReferenceError> reference;  ///< from which equal_effect is counted
  std::vector<double> equal_effect;         ///< [P] from the reference; NaN without one
  std::vector<double> mean_square_share;    ///< [P] at the sizes that the study sets
  MeanSquare mean_square;                   ///< for any tolerances
};

/// sigma [P] with every length replaced by the median of the lengths, and every angle by that of the angles: the
/// proportions of equal tolerances.
std::vector<double> one_size_for_each(std::span<const double> sigma, std::span<const Dimension> dimension);

/// From this reference; without one equal_effect is NaN.
Tolerances tolerances(const ResponseStudy& study, const std::optional<ReferenceError>& reference);

/// Tolerances that keep the root mean square of a response over samples and poses at a limit, and so its mean below.
struct LimitTolerances {
  double limit = 0.0;  ///< on the response, SI
  /// [P] every error has the same effect: t_p = k / mu_p, up to the largest tolerance that it may have. One without
  /// effect on its own may act together with others, so it has its equal tolerance.
  std::vector<double> equal_effect;
  std::vector<double> equal_tolerance;  ///< [P] one number for all lengths, one for all angles
};

/// one_size: [P] the proportions of equal_tolerance; largest: [P] that equal_effect may be. Precondition: limit^2 >
/// response.background.
LimitTolerances limit_tolerances(const ResponseStudy& study, const MeanSquare& response,
                                 std::span<const double> one_size, double limit, std::span<const double> largest);

}  // namespace poesy
