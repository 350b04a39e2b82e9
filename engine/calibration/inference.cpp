#include "engine/calibration/inference.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace poesy::calibration {
namespace {

// A fitted number is undetermined if its diagonal element of the projector on the null space exceeds this.
constexpr double kUnseenShare = 1e-6;
constexpr double kLeastFreedom = 1e-6;  // a value with 1 - leverage below this is not checked by any other value
constexpr double kFalseOutlier = 0.01;  // probability that any value is called an outlier although none is

/// The covariance of the scaled numbers, for the stated noise. Without a prior it is 0 along directions that are not
/// determined. prior: Prior::root times the scale.
Matrix scaled_covariance(const ScaledFit& fit, const Matrix& prior) {
  if (prior.rows() == 0) {
    const auto r = static_cast<Eigen::Index>(fit.rank);
    const Matrix V = fit.V.leftCols(r) * fit.singular_values.head(r).cwiseInverse().asDiagonal();
    return V * V.transpose();
  }
  Matrix all(fit.reduced.rows() + prior.rows(), prior.cols());
  all << fit.reduced, prior;
  const Matrix R = linalg::upper_triangle(all);
  const Matrix inverse = linalg::inverse(R);
  return inverse * inverse.transpose();
}

/// Sets the results of the chi-square test (dof, p), the root mean square, and the estimated factor of the noise.
void test(const FitResult& fit, bool has_prior, const InferenceOptions& options, Inference& found) {
  const auto m = static_cast<std::size_t>(fit.residual.size());
  const std::size_t used = fit.scaled.frame_rank() + (has_prior ? 0 : fit.scaled.rank);
  found.dof = m - std::min(m, used);
  found.rms = std::sqrt(fit.noise_sum / static_cast<double>(m));
  if (found.dof == 0) return;
  const auto dof = static_cast<double>(found.dof);
  found.p = boost::math::cdf(boost::math::complement(boost::math::chi_squared(dof), fit.sum));
  if (options.sd_is_estimated) found.sd_factor = std::sqrt(fit.sum / dof);
}

/// The quantile of the normal distribution, or of Student's t with `dof` degrees of freedom if the noise is estimated.
double quantile(double share, bool is_estimated, std::size_t dof) {
  if (!is_estimated) return boost::math::quantile(boost::math::normal(), share);
  if (dof == 0) return kNaN;
  return boost::math::quantile(boost::math::students_t(static_cast<double>(dof)), share);
}

void set_intervals(const FitResult& fit, const Vector& scale, bool has_prior, const InferenceOptions& options,
                   Inference& found) {
  const Eigen::Index k = scale.size();
  found.quantile = quantile(0.5 + 0.5 * options.conf_level, options.sd_is_estimated, found.dof);
  found.sd = found.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  found.correlation = Matrix::Constant(k, k, kNaN);
  for (Eigen::Index j = 0; j < k; ++j) {
    if (!has_prior && found.null_projector(j, j) > kUnseenShare) found.sd(j) = kNaN;
  }
  for (Eigen::Index i = 0; i < k; ++i) {
    for (Eigen::Index j = 0; j < k; ++j) {
      found.correlation(i, j) = found.covariance(i, j) / (found.sd(i) * found.sd(j));
    }
  }
  found.low = fit.theta - found.quantile * found.sd;
  found.high = fit.theta + found.quantile * found.sd;
}

/// Sets standardised residuals, leverages and outliers.
void set_residuals(const FitResult& fit, const Vector& sd, const Matrix& covariance, const InferenceOptions& options,
                   Inference& found) {
  const Eigen::Index m = sd.size();
  const Matrix& A = fit.scaled.reduced;
  found.leverage = (A * covariance).cwiseProduct(A).rowwise().sum() + fit.scaled.frame.rowwise().squaredNorm();
  found.standardised = Vector::Constant(m, kNaN);
  found.outlier_score = Vector::Constant(m, kNaN);
  const auto dof = static_cast<double>(found.dof);
  for (Eigen::Index i = 0; i < m; ++i) {
    const double freedom = 1.0 - found.leverage(i);
    if (freedom < kLeastFreedom) {
      found.unchecked.push_back(static_cast<std::size_t>(i));
      continue;
    }
    const double t = fit.residual(i) / (sd(i) * found.sd_factor * std::sqrt(freedom));
    found.standardised(i) = t;
    found.outlier_score(i) = options.sd_is_estimated ? t * std::sqrt((dof - 1.0) / std::max(dof - t * t, 1e-12)) : t;
  }
  if (options.sd_is_estimated && found.dof < 2) return;
  found.outlier_limit = quantile(1.0 - kFalseOutlier / (2.0 * static_cast<double>(m)), options.sd_is_estimated,
                                 found.dof - (options.sd_is_estimated ? 1 : 0));
  for (Eigen::Index i = 0; i < m; ++i) {
    if (std::abs(found.outlier_score(i)) > found.outlier_limit) found.outliers.push_back(static_cast<std::size_t>(i));
  }
  std::ranges::stable_sort(found.outliers, std::ranges::greater(),
                           [&](std::size_t i) { return std::abs(found.outlier_score(static_cast<Eigen::Index>(i))); });
}

ObservabilityIndices indices_of(const Vector& s, std::size_t poses) {
  ObservabilityIndices found;
  if (s.size() == 0) return found;
  const double first = s(0);
  const double last = s(s.size() - 1);
  found.O1 = std::exp(s.array().log().mean()) / std::sqrt(static_cast<double>(poses));
  found.O2 = last / first;
  found.O3 = last;
  found.O4 = last * last / first;
  found.O5 = 1.0 / s.cwiseInverse().sum();
  found.condition = first / last;
  return found;
}

}  // namespace

Matrix null_projector(const ScaledFit& fit) {
  const Eigen::Index k = fit.V.cols();
  const Matrix unseen = fit.V.rightCols(k - static_cast<Eigen::Index>(fit.rank));
  return unseen * unseen.transpose();
}

Inference infer(const FitResult& fit, const Vector& sd, const Vector& scale, const Prior& prior,
                const InferenceOptions& options) {
  Inference found;
  const bool has_prior = prior.root.rows() > 0;
  const Matrix of_prior = prior.root * scale.asDiagonal();
  const Matrix covariance = scaled_covariance(fit.scaled, of_prior);
  found.null_projector = null_projector(fit.scaled);
  test(fit, has_prior, options, found);
  found.covariance = found.sd_factor * found.sd_factor * (scale.asDiagonal() * covariance * scale.asDiagonal());
  set_intervals(fit, scale, has_prior, options, found);
  set_residuals(fit, sd, covariance, options, found);
  const Vector& s = fit.scaled.singular_values;
  const auto unlisted = static_cast<std::size_t>(scale.size() - s.size());
  found.below_noise = static_cast<std::size_t>((s.array() < 1.0).count()) + unlisted;
  found.indices = indices_of(s.head(static_cast<Eigen::Index>(fit.scaled.rank)), options.poses);
  return found;
}

std::vector<Confounded> confounded(const Matrix& null_projector) {
  const auto k = static_cast<std::size_t>(null_projector.rows());
  const auto share = [&](std::size_t i, std::size_t j) {
    return std::abs(null_projector(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  };
  std::vector<bool> listed(k, false);
  std::vector<Confounded> parts;
  for (std::size_t first = 0; first < k; ++first) {
    if (listed[first] || share(first, first) <= kUnseenShare) continue;
    Confounded part{{first}};
    listed[first] = true;
    for (std::size_t n = 0; n < part.numbers.size(); ++n) {
      for (std::size_t j = 0; j < k; ++j) {
        if (listed[j] || share(j, j) <= kUnseenShare || share(part.numbers[n], j) <= kUnseenShare) continue;
        listed[j] = true;
        part.numbers.push_back(j);
      }
    }
    std::ranges::sort(part.numbers);
    const double directions = std::accumulate(part.numbers.begin(), part.numbers.end(), 0.0,
                                              [&](double sum, std::size_t j) { return sum + share(j, j); });
    part.directions = static_cast<std::size_t>(std::lround(directions));
    parts.push_back(std::move(part));
  }
  return parts;
}

double sd_of(const Vector& gradient, const Inference& inference, const Vector& scale, bool has_prior) {
  const Vector scaled = gradient.cwiseProduct(scale);
  const double unseen = scaled.dot(inference.null_projector * scaled);
  if (!has_prior && unseen > kUnseenShare * scaled.squaredNorm()) return kNaN;
  return std::sqrt(std::max(gradient.dot(inference.covariance * gradient), 0.0));
}

}  // namespace poesy::calibration
