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
/// SI. Infinity means that the error alone has no effect; NaN means that its effect is not known.
namespace poesy {

/// The results of a sensitivity study for one response, SI. Keeps references to the study's arrays.
struct ResponseStudy {
  /// A number for each error and pose.
  template <class T>
  using Cells = ArrayView<const T, axis::Factor, axis::Pose>;

  std::vector<double> index;           ///< [errors] global index, with rounding removed (stats/indices.h)
  std::span<const double> sigma;       ///< [errors] standard deviations of the errors in the study
  Cells<std::uint64_t> count;          ///< number of samples for each error and pose
  Cells<double> mean;                  ///< mean of the response while one error varies
  Cells<double> std;                   ///< standard deviation of the response while one error varies
  std::span<const double> background;  ///< [poses] the response with all varied errors zero
  /// [errors] means of the errors in the study; empty if all are zero. If the response has the slope a in an error of
  /// mean m and standard deviation s, this error adds a^2 (m^2 + s^2) to the mean square. Its effect is the part a^2
  /// s^2.
  std::span<const double> error_mean = {};
};

/// The error relative to which equal-effect tolerances are set.
struct ReferenceError {
  std::size_t factor;  ///< position of the error in the study's list of errors, from 0
  double tolerance;    ///< tolerance of this error, SI
};

/// The position (from 0) of the error with the smallest effect that is not zero. The effect is sensitivity index x
/// sigma. None if no error has an effect.
std::optional<std::size_t> smallest_effect(std::span<const double> index, std::span<const double> sigma);

/// [errors] t_p = (mu_ref / mu_p) t_ref, with the indices mu_p. These tolerances give every error the effect of the
/// reference (Du et al. 2022, Section 6.3, Table 10). All NaN if the reference has no effect.
std::vector<double> equal_effect_tolerances(std::span<const double> index, const ReferenceError& reference);

/// The mean square of a response over the poses, for independent errors of mean zero and standard deviations t_p:
/// background + sum of effects_p t_p^2. Exact for a response that is linear in the errors or the norm of a linear
/// function; for others see Response::mean_square_bound. The root of the mean square is at least the mean of the
/// response (Jensen).
struct MeanSquare {
  double background = 0.0;      ///< mean square over the poses of the response with all varied errors zero
  std::vector<double> effects;  ///< [errors] increase of the mean square per t_p^2; 0 for errors without effect

  /// The sum of effects_p t_p^2. Errors without effect do not count, even if their tolerance is infinite.
  double growth(std::span<const double> tolerances) const;
  /// The mean square if some errors keep fixed sizes: their part becomes background. errors: positions of these errors
  /// in the list, from 0. sizes: [errors] standard deviations, of which only those of `errors` are used.
  MeanSquare holding(std::span<const std::size_t> errors, std::span<const double> sizes) const;
  /// The mean square with these tolerances [errors].
  double at(std::span<const double> tolerances) const { return background + growth(tolerances); }
};

/// The mean square from the study's own samples. effects_p is the mean over the poses of (mean square of the samples -
/// background^2), divided by sigma_p^2 + mean_p^2 of the error; 0 if it is negative or the error has no effect. NaN if
/// a pose has no background, or fewer than two samples of an error, or if an index is not known.
MeanSquare mean_square(const ResponseStudy& study);

/// [errors] The share of each error in the increase of the mean square by all errors with these standard deviations:
/// effects_p sigma_p^2 over the sum of these products. All NaN if an effect is not known or no error has one.
std::vector<double> mean_square_shares(const MeanSquare& response, std::span<const double> sigma);

/// [errors] The proportions times a common factor. The factor makes the predicted mean square limit^2. An infinite
/// proportion gives an infinite tolerance. The tolerance of an error with an effect is at most largest [errors]. If
/// this bound lowers a tolerance, the others grow until the limit is reached. NaN if the prediction is not known.
/// Precondition: limit^2 > response.background.
std::vector<double> tolerances_within(const MeanSquare& response, std::span<const double> proportions, double limit,
                                      std::span<const double> largest);

/// Tolerances of all errors for one response.
struct Tolerances {
  std::optional<ReferenceError> reference;  ///< reference error of equal_effect
  std::vector<double> equal_effect;         ///< [errors] tolerances relative to the reference; NaN without a reference
  /// [errors] Shares in the mean square, for the sizes of the errors in the study.
  std::vector<double> mean_square_share;
  MeanSquare mean_square;  ///< mean square of the response as a function of the tolerances
};

/// [errors] sigma with each value replaced by the median over all errors of its dimension (length, angle or number).
/// These are the proportions of equal tolerances.
std::vector<double> one_size_for_each(std::span<const double> sigma, std::span<const Dimension> dimension);

/// The tolerances for this reference; without a reference, equal_effect is NaN.
Tolerances tolerances(const ResponseStudy& study, const std::optional<ReferenceError>& reference);

/// Tolerances with which the root mean square of a response, over samples and poses, equals a limit. The mean of the
/// response is then below the limit.
struct LimitTolerances {
  double limit = 0.0;  ///< limit on the response, SI
  /// [errors] Tolerances for equal effects: t_p = k / mu_p with the indices mu_p and one factor k for all errors, up to
  /// the largest tolerance of each error. An error without an effect may still act together with others, so it gets its
  /// equal_tolerance.
  std::vector<double> equal_effect;
  std::vector<double> equal_tolerance;  ///< [errors] one number for each dimension (length, angle, number)
};

/// The tolerances for this limit. one_size: [errors] the proportions of equal_tolerance. largest: [errors] upper bounds
/// of equal_effect. Precondition: limit^2 > response.background.
LimitTolerances limit_tolerances(const ResponseStudy& study, const MeanSquare& response,
                                 std::span<const double> one_size, double limit, std::span<const double> largest);

}  // namespace poesy
