#include "engine/stats/indices.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {

namespace {

constexpr Interval kUnknown{kNaN, kNaN};

/// The fewest samples for an interval. Fewer say too little about a kurtosis (Bonett's trimmed mean needs more than
/// four).
constexpr std::uint64_t kFewestSamples = 5;

double square(double x) { return x * x; }

/// Standard error of the logarithm of the sample variance, without the small-sample factor (Bonett 2006).
double log_variance_error(const Moments& response) {
  const auto n = static_cast<double>(response.count());
  return std::sqrt((response.kurtosis() - (n - 3.0) / n) / (n - 1.0));
}

Interval local_interval(const Moments& response, double value, double conf_level) {
  if (response.count() >= 2 && value == 0.0) return {0.0, 0.0};
  const auto n = static_cast<double>(response.count());
  const double z = two_sided_normal_quantile(conf_level);
  if (response.count() < kFewestSamples || n <= z) return kUnknown;
  const double factor = n / (n - z);
  const double half = 0.5 * z * factor * log_variance_error(response);
  const double centre = value * std::sqrt(factor);
  return {centre * std::exp(-half), centre * std::exp(half)};
}

/// Statistics of the mean and the spread over M poses, from indices x_i with sampling variances v_i.
struct PoseStatistics {
  double mean;
  double mean_variance;
  double seen2;            ///< sample variance of the x_i
  double noise2;           ///< expected part of seen2 that is sampling noise
  double noise_variance;   ///< variance of seen2 if the true spread is zero
  double signal_variance;  ///< growth of the variance of seen2 per unit of true spread^2
  double covariance;       ///< covariance of the mean and seen2

  /// Unbiased estimate of the true spread^2; negative if by chance seen2 is below the noise.
  double spread2() const { return seen2 - noise2; }
  double spread() const { return std::sqrt(std::max(spread2(), 0.0)); }
  double spread2_variance() const { return noise_variance + signal_variance * std::max(spread2(), 0.0); }
};

/// The index x of a pose, corrected for the bias of a sample standard deviation. With the sampling variance v of x, the
/// bias is -v / (2 x) on average (second order of the square root).
double unbiased(const LocalIndex& pose) {
  return pose.value == 0.0 ? 0.0 : pose.value + 0.5 * square(pose.standard_error) / pose.value;
}

/// Computes the statistics over the M poses. The sample variance is x' A x / (M - 1), where the matrix A subtracts the
/// mean. For independent x_i with means mu_i and variances v_i, and V = diag(v), its variance is (4 mu' A V A mu + 2
/// tr(A V A V)) / (M - 1)^2. Its covariance with the mean is 2 1' V A mu / (M (M - 1)).
PoseStatistics statistics_over(std::span<const LocalIndex> poses) {
  const auto m = static_cast<double>(poses.size());
  const double freedom = std::max(m - 1.0, 1.0);
  double sum = 0.0;
  double v_sum = 0.0;
  double v2_sum = 0.0;
  for (const LocalIndex& pose : poses) {
    const double v = square(pose.standard_error);
    sum += unbiased(pose);
    v_sum += v;
    v2_sum += square(v);
  }
  const double mean = sum / m;
  double d2_sum = 0.0;
  double vd_sum = 0.0;
  double vd2_sum = 0.0;
  for (const LocalIndex& pose : poses) {
    const double v = square(pose.standard_error);
    const double d = unbiased(pose) - mean;
    d2_sum += square(d);
    vd_sum += v * d;
    vd2_sum += v * square(d);
  }
  const double trace = v2_sum * (1.0 - 2.0 / m) + square(v_sum) / square(m);
  // mu' A V A mu = (sum of v d^2 over sum of d^2) (M - 1) spread^2, with the deviations d_i of the x_i from their mean.
  // The quotient is a weighted mean of the v_i, so unlike its noisy numerator it is always between the smallest and the
  // largest v_i.
  const double v_of_spread = d2_sum > 0.0 ? vd2_sum / d2_sum : 0.0;
  return {.mean = mean,
          .mean_variance = v_sum / square(m),
          .seen2 = d2_sum / freedom,
          .noise2 = poses.size() > 1 ? v_sum / m : 0.0,
          .noise_variance = 2.0 * trace / square(freedom),
          .signal_variance = 4.0 * v_of_spread / freedom,
          .covariance = 2.0 * vd_sum / (m * freedom)};
}

/// Returns true if noise alone would give at least this spread with a probability above `level`. Without true spread,
/// seen2 is distributed as noise2 / f times a chi-square with f = 2 noise2^2 / noise_variance degrees of freedom
/// (Satterthwaite).
bool may_be_noise(const PoseStatistics& s, double level) {
  if (s.seen2 == 0.0) return true;
  const double noise4 = square(s.noise2);
  if (noise4 == 0.0 || s.noise_variance == 0.0) return false;  // either may underflow before the other
  return boost::math::gamma_q(noise4 / s.noise_variance, s.seen2 * s.noise2 / s.noise_variance) > level;
}

/// The true spreads x that the data do not contradict: |spread2() - x^2| <= z sqrt(variance if x were true). Unlike an
/// interval from the variance at the estimate, this one is valid near zero spread.
Interval spread_interval(const PoseStatistics& s, double z) {
  const double middle = s.spread2() + 0.5 * square(z) * s.signal_variance;
  const double under_root =
      square(z) * (s.noise_variance + s.signal_variance * s.spread2()) + square(0.5 * square(z) * s.signal_variance);
  const double half = std::sqrt(std::max(under_root, 0.0));
  return {std::sqrt(std::max(middle - half, 0.0)), std::sqrt(std::max(middle + half, 0.0))};
}

/// The distance from mean + spread to one end of the interval of this sum. of_mean: the distance from the mean to the
/// same end of the mean's interval; of_spread: the same for the spread (Zou and Donner 2008, with a correlation).
double recovered(double of_mean, double of_spread, double correlation) {
  const double sum = square(of_mean) + square(of_spread) + 2.0 * correlation * of_mean * of_spread;
  return std::sqrt(std::max(sum, 0.0));
}

/// Mean + spread without sampling noise, and the interval of this sum. Precondition: is_known(poses).
Estimate without_noise(std::span<const LocalIndex> poses, double conf_level) {
  const double z = two_sided_normal_quantile(conf_level);
  const PoseStatistics s = statistics_over(poses);
  const double of_mean = z * std::sqrt(s.mean_variance);
  const double scale = std::sqrt(s.mean_variance * s.spread2_variance());
  const double correlation = scale > 0.0 ? std::clamp(s.covariance / scale, -1.0, 1.0) : 0.0;
  const double centre = s.mean + s.spread();
  const Interval spread = spread_interval(s, z);
  const double up = recovered(of_mean, std::max(spread.high - s.spread(), 0.0), correlation);
  // If the interval of the spread begins at 0, the formula of recovered() almost leaves out the error of the mean. Then
  // the lower limit is that of the mean alone.
  const double low = may_be_noise(s, 0.5 * (1.0 - conf_level)) || spread.low == 0.0
                         ? s.mean - of_mean
                         : centre - recovered(of_mean, s.spread() - spread.low, correlation);
  return {centre, {std::max(low, 0.0), centre + up}};
}

/// Returns true if there is a pose, and every pose has an index and a standard error.
bool is_known(std::span<const LocalIndex> poses) {
  return !poses.empty() && std::ranges::all_of(poses, [](const LocalIndex& pose) {
    return std::isfinite(pose.value) && std::isfinite(pose.standard_error);
  });
}

}  // namespace

Estimate local_index(const Moments& response, double error_sigma, double conf_level) {
  POESY_EXPECTS(error_sigma > 0.0);
  const double value = response.standard_deviation() / error_sigma;
  return {value, local_interval(response, value, conf_level)};
}

LocalIndex local_index_with_error(const Moments& response, double error_sigma) {
  POESY_EXPECTS(error_sigma > 0.0);
  const double value = response.standard_deviation() / error_sigma;
  if (value == 0.0) return {0.0, 0.0};
  if (response.count() < kFewestSamples) return {value, kNaN};
  return {value, 0.5 * value * log_variance_error(response)};
}

double published_index(std::span<const LocalIndex> poses) {
  if (poses.empty()) return kNaN;
  Moments over_poses;
  for (const LocalIndex& pose : poses) over_poses.add(pose.value);
  return over_poses.mean() + (poses.size() > 1 ? over_poses.standard_deviation() : 0.0);
}

Estimate global_index(std::span<const LocalIndex> poses, double conf_level) {
  const double value = published_index(poses);
  if (!is_known(poses)) return {value, kUnknown};
  Interval interval = without_noise(poses, conf_level).interval;
  interval.high = std::max(interval.high, value);
  return {value, interval};
}

Estimate corrected_global_index(std::span<const LocalIndex> poses, double conf_level) {
  if (!is_known(poses)) return {published_index(poses), kUnknown};
  return without_noise(poses, conf_level);
}

bool changes_with_size(double change) { return std::abs(change) > kIndexHolds; }

double index_rounding(double response_rounding, double sigma) {
  return std::max(kIndexRounding, response_rounding / sigma);
}

double size_rounding(double response_rounding, double linear, double angular) {
  return std::max(response_rounding, kIndexRounding * std::fmax(linear, angular));  // fmax ignores NaN
}

double joint_rounding(double response_rounding, std::span<const double> sigma) {
  double squares = 0.0;
  for (const double one : sigma) squares += square(index_rounding(response_rounding, one) * one);
  return std::sqrt(squares);
}

bool is_constant(std::span<const double> deviations, double rounding) {
  const auto is_unknown = [](double deviation) { return std::isnan(deviation); };
  return !std::ranges::all_of(deviations, is_unknown) &&
         std::ranges::none_of(deviations, [&](double deviation) { return has_effect(deviation, rounding); });
}

bool has_effect(double index, double rounding) { return index >= rounding; }

bool is_too_small_to_tell(double index, double rounding) {
  return rounding > kIndexOfInterest && !has_effect(index, rounding);
}

double told_from_rounding(double index, double rounding) {
  if (std::isnan(index) || has_effect(index, rounding)) return index;
  return is_too_small_to_tell(index, rounding) ? kNaN : 0.0;
}

}  // namespace poesy
