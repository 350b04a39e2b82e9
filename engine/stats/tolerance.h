#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/units.h"
#include "engine/stats/indices.h"

/// Tolerances from the indices of a sensitivity study. Here a tolerance is the standard deviation of a normal error,
/// SI; infinity means that the error has no effect alone, NaN that its effect is not known.
namespace poesy {

/// One response of a sensitivity study with P errors and M poses, SI. Refers to the study's arrays.
struct ResponseStudy {
  /// A number for each error and pose.
  template <class T>
  using Cells = ArrayView<const T, axis::Factor, axis::Pose>;

  std::vector<double> index;           ///< [P] global index, with rounding removed (stats/indices.h)
  std::span<const double> sigma;       ///< [P] standard deviations of the errors in the study
  Cells<std::uint64_t> count;          ///< number of samples
  Cells<double> mean;                  ///< mean of the response while one error varies
  Cells<double> std;                   ///< standard deviation of the response while one error varies
  std::span<const double> background;  ///< [M] the response with all varied errors zero
  /// [P] means of the errors in the study; empty if all are zero. An error of mean m and deviation s adds a^2 (m^2 +
  /// s^2) to the mean square, of which a^2 s^2 is its effect.
  std::span<const double> error_mean = {};
};

/// The error relative to which equal-effect tolerances are set.
struct ReferenceError {
  std::size_t factor;  ///< position among the P errors
  double tolerance;    ///< SI
};

/// The error with the smallest nonzero effect, index x sigma; none if no error has an effect.
std::optional<std::size_t> smallest_effect(std::span<const double> index, std::span<const double> sigma);

/// [P] t_p = (mu_ref / mu_p) t_ref, which gives every error the effect of the reference (Du et al. 2022, Section 6.3,
/// Table 10). All NaN if the reference has no effect.
std::vector<double> equal_effect_tolerances(std::span<const double> index, const ReferenceError& reference);

/// The mean square of a response over the poses, for independent errors of mean zero and standard deviations t_p:
/// background + sum of effects_p t_p^2. Exact for a response that is linear in the errors or the norm of a linear
/// function; for others see Response::mean_square_bound. Its root is at least the mean of the response (Jensen).
struct MeanSquare {
  double background = 0.0;      ///< mean square over the poses of the response to the background alone
  std::vector<double> effects;  ///< [P] increase of the mean square per t_p^2; 0 for errors without effect

  /// sum of effects_p t_p^2. Errors without effect do not count, whatever their tolerance.
  double growth(std::span<const double> tolerances) const;
  /// The mean square if these errors, by position, always have these sizes [P]: their part moves to the background.
  MeanSquare holding(std::span<const std::size_t> errors, std::span<const double> sizes) const;
  /// The mean square with these tolerances [P].
  double at(std::span<const double> tolerances) const { return background + growth(tolerances); }
};

/// The mean square from the study's own samples: effects_p = mean over the poses of (mean square of the samples -
/// background^2), or 0 if that is negative, over sigma_p^2. NaN if a pose has no background, or fewer than two samples
/// of an error, or if an index is not known.
MeanSquare mean_square(const ResponseStudy& study);

/// [P] effects_p sigma_p^2 over its sum: the share of each error in the increase of the mean square by all errors with
/// these standard deviations. All NaN if an effect is not known or no error has one.
std::vector<double> mean_square_shares(const MeanSquare& response, std::span<const double> sigma);

/// The multiple of `proportions` [P] whose predicted mean square is limit^2; infinite proportions stay so. A tolerance
/// of an error with effect is at most largest [P]; what such an error leaves of the limit is divided among the others.
/// NaN if the prediction is not known. Precondition: limit^2 > background.
std::vector<double> tolerances_within(const MeanSquare& response, std::span<const double> proportions, double limit,
                                      std::span<const double> largest);

/// Tolerances of all errors for one response.
struct Tolerances {
  std::optional<ReferenceError> reference;  ///< relative to which equal_effect is set
  std::vector<double> equal_effect;         ///< [P] tolerances relative to the reference; NaN without one
  std::vector<double> mean_square_share;    ///< [P] for the sizes in the study
  MeanSquare mean_square;                   ///< the mean square for any tolerances
};

/// sigma [P] with every length replaced by the median length, and every angle by the median angle: the proportions of
/// equal tolerances.
std::vector<double> one_size_for_each(std::span<const double> sigma, std::span<const Dimension> dimension);

/// The tolerances relative to this reference; without one, equal_effect is NaN.
Tolerances tolerances(const ResponseStudy& study, const std::optional<ReferenceError>& reference);

/// Tolerances with which the root mean square of a response over samples and poses is at a limit, and its mean below.
struct LimitTolerances {
  double limit = 0.0;  ///< limit on the response, SI
  /// [P] Equal effects: t_p = k / mu_p, up to the largest tolerance of the error. An error without effect alone may act
  /// together with others, so it has its equal tolerance.
  std::vector<double> equal_effect;
  std::vector<double> equal_tolerance;  ///< [P] one number for all lengths, one for all angles
};

/// one_size: [P] the proportions of equal_tolerance; largest: [P] upper bounds of equal_effect. Precondition: limit^2 >
/// response.background.
LimitTolerances limit_tolerances(const ResponseStudy& study, const MeanSquare& response,
                                 std::span<const double> one_size, double limit, std::span<const double> largest);

}  // namespace poesy
