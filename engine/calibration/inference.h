#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/base/nan.h"
#include "engine/calibration/fit.h"

namespace poesy::calibration {

/// How standard deviations and intervals are computed.
struct InferenceOptions {
  bool sd_is_estimated = false;  ///< true if the noise is known only up to a common factor, which is then estimated
  double conf_level = 0.95;      ///< confidence level of the intervals
  std::size_t poses = 0;         ///< number of measured poses, for the observability indices
};

/// Observability indices: how well a set of n poses determines the fitted numbers. They are functions of the singular
/// values s_1 >= ... >= s_r of ScaledFit::reduced, where r is its rank (Borm and Menq 1991, Driels and Pathre 1990,
/// Nahvi et al. 1994, Sun and Hollerbach 2008).
struct ObservabilityIndices {
  double O1 = kNaN;         ///< (s_1 ... s_r)^(1/r) / sqrt(n): geometric mean divided by sqrt(n)
  double O2 = kNaN;         ///< s_r / s_1: ratio of the smallest to the largest
  double O3 = kNaN;         ///< s_r
  double O4 = kNaN;         ///< s_r^2 / s_1: squared smallest, divided by the largest
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
  /// [numbers x numbers] Projector on the directions of the scaled numbers that the measurements leave undetermined,
  /// whatever the prior.
  Matrix null_projector;
  double quantile = kNaN;  ///< half-width of an interval divided by the standard deviation
  double sd_factor = 1.0;  ///< estimated ratio of the actual to the stated noise; 1 if the noise is known
  std::size_t dof = 0;     ///< degrees of freedom of the minimised sum of squares (FitResult::sum)
  double p = kNaN;         ///< probability that pure noise gives a larger sum of squares; NaN if dof is 0
  double rms = kNaN;       ///< root mean square of the residuals, each divided by the standard deviation of its value
  Vector leverage;         ///< [values] derivative of each fitted value with respect to its measured value, 0 to 1
  Vector standardised;     ///< [values] residuals divided by their own standard deviations; NaN if unchecked
  /// [values] Statistic of the outlier test: the standardised residual. If the noise is estimated, the statistic uses
  /// an estimate from the other values only. NaN for an unchecked value.
  Vector outlier_score;
  double outlier_limit = kNaN;         ///< a value whose |outlier_score| exceeds this is an outlier
  std::vector<std::size_t> outliers;   ///< indices of the outliers, largest |outlier_score| first
  std::vector<std::size_t> unchecked;  ///< indices of values with leverage 1, which no other value checks
  std::size_t below_noise = 0;         ///< number of singular values below 1: effects that are below the noise
  ObservabilityIndices indices;        ///< observability indices of the first ScaledFit::rank singular values
};

/// Computes the inference from a solved fit. sd, scale and prior: as in the FitProblem.
Inference infer(const FitResult& fit, const Vector& sd, const Vector& scale, const Prior& prior,
                const InferenceOptions& options);

/// [numbers x numbers] The projector on the directions of the scaled numbers that the measurements do not determine.
Matrix null_projector(const ScaledFit& fit);

/// A group of fitted numbers that the measurements cannot tell apart: a connected block of null_projector().
struct Confounded {
  std::vector<std::size_t> numbers;  ///< indices of the fitted numbers
  std::size_t directions = 0;        ///< number of undetermined directions of these numbers
};

/// The groups of confounded numbers, ordered by their first number.
std::vector<Confounded> confounded(const Matrix& null_projector);

/// The standard deviation of a function of the fitted numbers. gradient: [numbers] derivatives of the function. scale:
/// [numbers] FittedDirections::scale. NaN if there is no prior and the function depends on directions that are not
/// determined.
double sd_of(const Vector& gradient, const Inference& inference, const Vector& scale, bool has_prior);

}  // namespace poesy::calibration
