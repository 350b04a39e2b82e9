#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/base/nan.h"
#include "engine/calibration/fit.h"

namespace poesy::calibration {

/// How standard deviations and intervals are found.
struct InferenceOptions {
  bool sd_is_estimated = false;  ///< whether the noise is known up to one factor only
  double conf_level = 0.95;      ///< of the intervals
  std::size_t poses = 0;         ///< number of poses, for the indices
};

/// Indices of how well a set of poses determines the fitted numbers, from the singular values s_1 >= ... >= s_r of the
/// scaled matrix (Borm and Menq 1991, Driels and Pathre 1990, Nahvi et al. 1994, Sun and Hollerbach 2008). n: number of
/// poses.
struct ObservabilityIndices {
  double O1 = kNaN;         ///< (s_1 ... s_r)^(1/r) / sqrt(n)
  double O2 = kNaN;         ///< s_r / s_1
  double O3 = kNaN;         ///< s_r
  double O4 = kNaN;         ///< s_r^2 / s_1
  double O5 = kNaN;         ///< 1 / (1/s_1 + ... + 1/s_r)
  double condition = kNaN;  ///< s_1 / s_r
};

/// What a fit tells, and how sure it is.
struct Inference {
  Vector sd;               ///< [k] standard deviations; NaN: not determined
  Vector low;              ///< [k] lower ends of the intervals
  Vector high;             ///< [k] upper ends of the intervals
  Matrix covariance;       ///< [k x k] of the determined part
  Matrix correlation;      ///< [k x k]; NaN for a number that is not determined
  Matrix null_projector;   ///< [k x k] on what is unseen, in scaled numbers; also with a prior
  double quantile = kNaN;  ///< half-width of an interval over the standard deviation
  double sd_factor = 1.0;  ///< factor of the stated noise, where it is estimated
  std::size_t dof = 0;     ///< degrees of freedom of S
  double p = kNaN;         ///< share of larger S if nothing but noise is left; NaN without degrees of freedom
  double rms = kNaN;       ///< root mean square of residuals over their standard deviations
  Vector leverage;         ///< [m] diagonal of the projector on what is fitted
  Vector standardised;     ///< [m] residuals over their own standard deviations; NaN where nothing else checks a value
  Vector outlier_score;    ///< [m] the same for the test: with estimated noise without the value itself
  double outlier_limit = kNaN;         ///< a larger outlier_score is an outlier
  std::vector<std::size_t> outliers;   ///< positions of the outliers, the largest first
  std::vector<std::size_t> unchecked;  ///< positions of values that nothing else checks
  std::size_t below_noise = 0;         ///< number of singular values below 1, of all k
  ObservabilityIndices indices;        ///< of the singular values up to the rank
};

/// The inference from a fit that was solved. prior: that of the fit.
Inference infer(const FitResult& fit, const Vector& sd, const Vector& scale, const Prior& prior,
                const InferenceOptions& options);

/// Numbers that no measurement tells apart: parts of the null space's projector that are connected.
struct Confounded {
  std::vector<std::size_t> numbers;  ///< positions of fitted numbers
  std::size_t directions = 0;        ///< how many directions are unseen
};

/// The parts, in the order of their first numbers.
std::vector<Confounded> confounded(const Matrix& null_projector);

/// The standard deviation of a function with this gradient; NaN if it depends on what is not determined. scale: that of
/// the fitted numbers.
double sd_of(const Vector& gradient, const Inference& inference, const Vector& scale, bool has_prior);

}  // namespace poesy::calibration
