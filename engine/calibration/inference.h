#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/base/nan.h"
#include "engine/calibration/fit.h"

namespace poesy::calibration {

/// How standard deviations and intervals are computed.
struct InferenceOptions {
  bool sd_is_estimated = false;  ///< whether the noise is known only up to a common factor
  double conf_level = 0.95;      ///< confidence level of the intervals
  std::size_t poses = 0;         ///< number of measured poses, which the observability indices need
};

/// Observability indices: how well a set of n poses determines the fitted numbers. They are functions of the singular
/// values s_1 >= ... >= s_r of the scaled matrix (Borm and Menq 1991, Driels and Pathre 1990, Nahvi et al. 1994, Sun
/// and Hollerbach 2008).
struct ObservabilityIndices {
  double O1 = kNaN;         ///< (s_1 ... s_r)^(1/r) / sqrt(n): geometric mean, over the root of the number of poses
  double O2 = kNaN;         ///< s_r / s_1: smallest over largest singular value
  double O3 = kNaN;         ///< s_r
  double O4 = kNaN;         ///< s_r^2 / s_1: square of the smallest over the largest
  double O5 = kNaN;         ///< 1 / (1/s_1 + ... + 1/s_r)
  double condition = kNaN;  ///< s_1 / s_r: condition number
};

/// The statistical results of a fit.
struct Inference {
  Vector sd;          ///< [numbers] standard deviations of the fitted numbers, SI; NaN if not determined
  Vector low;         ///< [numbers] lower ends of the confidence intervals, SI
  Vector high;        ///< [numbers] upper ends of the confidence intervals, SI
  Matrix covariance;  ///< [numbers x numbers] covariance of the fitted numbers, SI; 0 along undetermined directions
  /// [numbers x numbers] Correlation of the fitted numbers; NaN for a number that is not determined.
  Matrix correlation;
  /// [numbers x numbers] Projector on the undetermined directions of the scaled numbers, without the prior.
  Matrix null_projector;
  double quantile = kNaN;  ///< half-width of an interval over the standard deviation
  double sd_factor = 1.0;  ///< estimated factor of the stated noise; 1 if the noise is known
  std::size_t dof = 0;     ///< degrees of freedom of the minimised sum of squares (FitResult::sum)
  double p = kNaN;         ///< probability of a larger sum of squares if residuals are only noise; NaN if dof is 0
  double rms = kNaN;       ///< root mean square of the residuals over their standard deviations
  Vector leverage;         ///< [values] diagonal of the projector on the fitted values
  Vector standardised;     ///< [values] residuals over their own standard deviations; NaN for an unchecked value
  /// [values] Statistic of the outlier test. If the noise is estimated, this test estimates it from the other values
  /// only.
  Vector outlier_score;
  double outlier_limit = kNaN;         ///< a value whose |outlier_score| exceeds this is an outlier
  std::vector<std::size_t> outliers;   ///< indices of the outliers, largest score first
  std::vector<std::size_t> unchecked;  ///< indices of values that no other value checks
  std::size_t below_noise = 0;         ///< number of singular values below 1 (effects below the noise)
  ObservabilityIndices indices;        ///< observability indices of the first `rank` singular values
};

/// The inference from a solved fit. sd, scale and prior: as in the fit.
Inference infer(const FitResult& fit, const Vector& sd, const Vector& scale, const Prior& prior,
                const InferenceOptions& options);

/// [numbers x numbers] The projector on the directions of the scaled numbers that the measurements do not determine.
Matrix null_projector(const ScaledFit& fit);

/// Fitted numbers that the measurements cannot tell apart: a connected block of the null space's projector.
struct Confounded {
  std::vector<std::size_t> numbers;  ///< indices of the fitted numbers
  std::size_t directions = 0;        ///< number of undetermined directions of these numbers
};

/// The groups of confounded numbers, ordered by their first number.
std::vector<Confounded> confounded(const Matrix& null_projector);

/// The standard deviation of a function of the fitted numbers. gradient: [numbers] its derivatives. scale: [numbers]
/// that of the fit. NaN if the function depends on directions that are not determined.
double sd_of(const Vector& gradient, const Inference& inference, const Vector& scale, bool has_prior);

}  // namespace poesy::calibration
