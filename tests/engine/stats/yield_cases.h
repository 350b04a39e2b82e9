#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "engine/random/distribution.h"
#include "engine/random/normal_copula.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"
#include "engine/random/weighted_points.h"
#include "engine/stats/yield_gradient.h"

// Machines whose only response is the sum of their errors, with the true gradients of their yield.

namespace poesy::test {

/// The score of one independent error.
inline ErrorScore score_of(const Distribution& distribution) {
  if (distribution.sigma() > 0.0) return NormalScore{distribution.sigma(), distribution.half_width()};
  const WeightedPoints points = weighted_points(distribution);
  return PolynomialScore(points.points, points.weights);
}

/// A machine is good if the magnitude of the sum of its errors is at most the limit.
struct YieldCase {
  std::vector<Distribution> errors;
  double limit;
  std::vector<double> gradient;          ///< true dY/dt, with the standard deviation t of each error
  std::vector<double> correlation = {};  ///< [errors x errors] of normal errors; empty: independent

  /// The scores of all errors.
  ErrorScores scores() const {
    ErrorScores made;
    for (const Distribution& error : errors) {
      made.each.push_back(correlation.empty() ? score_of(error) : BlockScore{error.sigma()});
    }
    if (correlation.empty()) return made;
    made.blocks.push_back({{}, lower_triangle(correlation)});
    for (std::size_t p = 0; p < errors.size(); ++p) made.blocks[0].errors.push_back(p);
    return made;
  }

  /// Replaces uniform numbers by errors. rows: [errors].
  void transform(std::span<const std::span<double>> rows) const {
    if (correlation.empty()) {
      for (std::size_t p = 0; p < rows.size(); ++p) errors[p].transform(rows[p]);
      return;
    }
    for (const std::span<double> row : rows) normal_quantiles(1.0, row);
    NormalCopula(correlation).correlate(rows);
    for (std::size_t p = 0; p < rows.size(); ++p) errors[p].transform_scores(rows[p]);
  }

  /// The estimated gradient of the yield from new random machines.
  std::vector<Estimate> estimate(std::size_t machines, double conf_level, boost::random::mt19937_64& engine) const {
    std::vector<double> values(errors.size() * machines);
    for (double& value : values) value = uniform_from_bits(engine());
    std::vector<std::span<double>> rows;
    for (std::size_t p = 0; p < errors.size(); ++p) {
      rows.push_back(std::span(values).subspan(p * machines, machines));
    }
    transform(rows);
    std::vector<std::uint8_t> rejected;
    for (std::size_t b = 0; b < machines; ++b) {
      double sum = 0.0;
      for (const std::span<double> row : rows) sum += row[b];
      rejected.push_back(static_cast<std::uint8_t>(std::abs(sum) > limit));
    }
    ScoreSums sums(scores());
    sums.add(values, rejected);
    return sums.gradient(conf_level);
  }
};

/// The derivative at x by a five-point formula.
inline double slope_at(double x, const std::function<double(double)>& function) {
  const double step = 1e-3 * x;
  return (8.0 * (function(x + step) - function(x - step)) - function(x + 2.0 * step) + function(x - 2.0 * step)) /
         (12.0 * step);
}

/// P(|sum| <= limit) for a sum of independent uniform variables with these half-widths, from the volume of a box cut by
/// a plane (Barrow and Smith 1979, Am. Math. Mon. 86, 704-708).
inline double share_of_uniforms(std::span<const double> half_widths, double limit) {
  double sum = 0.0;
  double box = 1.0;
  for (std::size_t p = 0; p < half_widths.size(); ++p) box *= 2.0 * half_widths[p] * static_cast<double>(p + 1);
  for (std::size_t signs = 0; signs < std::size_t{1} << half_widths.size(); ++signs) {
    double corner = limit;
    double sign = 1.0;
    for (std::size_t p = 0; p < half_widths.size(); ++p) {
      const bool minus = (signs >> p & 1) == 1;
      corner += minus ? -half_widths[p] : half_widths[p];
      sign = minus ? -sign : sign;
    }
    if (corner > 0.0) sum += sign * std::pow(corner, static_cast<double>(half_widths.size()));
  }
  return 2.0 * sum / box - 1.0;
}

/// Independent normal errors.
inline YieldCase normal_case(std::span<const double> sigma, double limit) {
  YieldCase made{{}, limit, {}};
  double variance = 0.0;
  for (const double one : sigma) variance += one * one;
  const double density = std::exp(-0.5 * limit * limit / variance) / std::sqrt(2.0 * std::numbers::pi);
  for (const double one : sigma) {
    made.errors.push_back(Distribution::normal(one));
    made.gradient.push_back(-2.0 * density * limit * one / std::pow(variance, 1.5));
  }
  return made;
}

/// Three normal errors with the same sigma. Any two of them have this correlation.
inline YieldCase correlated_case(double sigma, double correlation, double limit) {
  constexpr std::size_t kErrors = 3;
  const double variance = sigma * sigma * (kErrors + kErrors * (kErrors - 1) * correlation);
  const double density = std::exp(-0.5 * limit * limit / variance) / std::sqrt(2.0 * std::numbers::pi);
  const double by_size = sigma * (1.0 + (kErrors - 1) * correlation);
  YieldCase made{std::vector(kErrors, Distribution::normal(sigma)), limit,
                 std::vector(kErrors, -2.0 * density * limit * by_size / std::pow(variance, 1.5)),
                 std::vector(kErrors * kErrors, correlation)};
  for (std::size_t p = 0; p < kErrors; ++p) made.correlation[p * kErrors + p] = 1.0;
  return made;
}

/// Independent uniform errors with these standard deviations.
inline YieldCase uniform_case(std::span<const double> sigma, double limit) {
  YieldCase made{{}, limit, {}};
  std::vector<double> half_widths;
  for (const double one : sigma) half_widths.push_back(std::numbers::sqrt3 * one);
  for (std::size_t p = 0; p < sigma.size(); ++p) {
    made.errors.push_back(Distribution::uniform(half_widths[p]));
    made.gradient.push_back(slope_at(sigma[p], [&](double other) {
      std::vector<double> widths = half_widths;
      widths[p] = std::numbers::sqrt3 * other;
      return share_of_uniforms(widths, limit);
    }));
  }
  return made;
}

/// Independent triangular errors with these standard deviations. Each is the sum of two uniform variables.
inline YieldCase triangular_case(std::span<const double> sigma, double limit) {
  YieldCase made{{}, limit, {}};
  std::vector<double> half_widths;
  for (const double one : sigma) half_widths.insert(half_widths.end(), 2, std::sqrt(1.5) * one);
  for (std::size_t p = 0; p < sigma.size(); ++p) {
    made.errors.push_back(Distribution::triangular(std::sqrt(6.0) * sigma[p]));
    made.gradient.push_back(slope_at(sigma[p], [&](double other) {
      std::vector<double> widths = half_widths;
      widths[2 * p] = widths[2 * p + 1] = std::sqrt(1.5) * other;
      return share_of_uniforms(widths, limit);
    }));
  }
  return made;
}

/// P(|m + e| <= limit) for a normal e and an m that is uniform from a to b.
inline double share_of_uniform(double a, double b, double sigma, double limit) {
  // an antiderivative of the normal distribution function
  const auto integral = [&](double x) {
    const double z = x / sigma;
    const double share = 0.5 * std::erfc(-z / std::numbers::sqrt2);
    return x * share + sigma * std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  };
  return (integral(limit - a) - integral(limit - b) - integral(-limit - a) + integral(-limit - b)) / (b - a);
}

/// P(|m + e| <= limit) for a normal e and a measured m. Each measured value is spread evenly over its range; no two
/// values are equal.
inline double share_of_measured(const SmoothedValues& parts, double sigma, double limit) {
  double sum = 0.0;
  for (std::size_t k = 0; k < parts.values().size(); ++k) {
    const double half = parts.half_widths()[k];
    sum += share_of_uniform(parts.values()[k] - half, parts.values()[k] + half, sigma, limit);
  }
  return sum / static_cast<double>(parts.values().size());
}

/// One measured error and one normal error. values: the measured values, no two of them equal.
inline YieldCase measured_case(const std::vector<double>& values, double sigma, double limit) {
  const Distribution measured = Distribution::measured(values);
  const auto grown = [&](double deviation) {
    std::vector<double> others;
    for (const double value : values) {
      others.push_back(measured.mean() + deviation / measured.standard_deviation() * (value - measured.mean()));
    }
    return share_of_measured(SmoothedValues(others), sigma, limit);
  };
  return {{measured, Distribution::normal(sigma)},
          limit,
          {slope_at(measured.standard_deviation(), grown),
           slope_at(sigma, [&](double other) { return share_of_measured(*measured.parts(), other, limit); })}};
}

}  // namespace poesy::test
