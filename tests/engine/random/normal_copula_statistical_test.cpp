#include "engine/random/normal_copula.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/random/distribution.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"
#include "engine/stats/rank_correlation.h"

// The seeds are fixed. Each check fails for a correct program with probability alpha = 0.001.

namespace poesy {
namespace {

constexpr double kZ = 3.291;
constexpr double kKolmogorov = 1.9495;  ///< quantile of sqrt(n) times the largest difference, at alpha
constexpr std::size_t kDraws = 200'000;

constexpr double kFirstTwo = 0.6;
constexpr double kFirstThird = -0.45;
constexpr double kLastTwo = 0.3;

/// [3][kDraws] Correlated errors with these three distributions.
std::vector<std::vector<double>> draws_of(const std::vector<Distribution>& distributions) {
  const NormalCopula copula(
      std::vector{1.0, kFirstTwo, kFirstThird, kFirstTwo, 1.0, kLastTwo, kFirstThird, kLastTwo, 1.0});
  std::vector<std::vector<double>> rows(3, std::vector<double>(kDraws));
  std::vector<std::span<double>> spans;
  for (std::size_t k = 0; k < 3; ++k) {
    fill_uniforms({.seed = 77, .factor = FactorIndex(k), .pose = PoseIndex(0)}, SampleIndex(0), rows[k]);
    normal_quantiles(1.0, rows[k]);
    spans.emplace_back(rows[k]);
  }
  copula.correlate(spans);
  for (std::size_t k = 0; k < 3; ++k) distributions[k].transform_scores(rows[k]);
  return rows;
}

std::vector<double> measured_values() {
  std::vector<double> values;
  for (int k = 0; k < 40; ++k) values.push_back(1.0 + 0.1 * k + 0.05 * std::sin(7.0 * k));
  return values;
}

/// Kolmogorov's statistic: the largest difference between the empirical distribution of draws and `distribution`.
double largest_difference(std::vector<double> draws, const Distribution& distribution) {
  std::ranges::sort(draws);
  double largest = 0.0;
  constexpr int kSteps = 20'000;
  for (int k = 1; k < kSteps; ++k) {
    const double share = static_cast<double>(k) / kSteps;
    const auto below = std::ranges::lower_bound(draws, distribution.quantile(share)) - draws.begin();
    largest = std::max(largest, std::abs(static_cast<double>(below) / kDraws - share));
  }
  return largest;
}

TEST(NormalCopula, KeepsEveryMarginalDistribution) {
  const std::vector<Distribution> distributions{Distribution::measured(measured_values()), Distribution::uniform(2.0),
                                                Distribution::truncated_normal(1.0, 1.5)};
  const auto rows = draws_of(distributions);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LT(std::sqrt(kDraws) * largest_difference(rows[k], distributions[k]), kKolmogorov) << k;
  }
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  double sx = 0.0;
  double sy = 0.0;
  for (std::size_t k = 0; k < kDraws; ++k) {
    sx += x[k];
    sy += y[k];
    xx += x[k] * x[k];
    yy += y[k] * y[k];
    xy += x[k] * y[k];
  }
  return (xy - sx * sy / kDraws) / std::sqrt((xx - sx * sx / kDraws) * (yy - sy * sy / kDraws));
}

// Fisher's transformation (atanh) of the correlation of n normal pairs has the standard error 1 / sqrt(n - 3).
TEST(NormalCopula, NormalErrorsHaveTheCorrelation) {
  const auto rows = draws_of({Distribution::normal(1e-3), Distribution::normal(2.0), Distribution::normal(0.5)});
  const auto expect_correlation = [&](std::size_t i, std::size_t j, double rho) {
    const double found = correlation(rows[i], rows[j]);
    EXPECT_LE(std::abs(std::atanh(found) - std::atanh(rho)), kZ / std::sqrt(kDraws - 3.0)) << i << j;
  };
  expect_correlation(0, 1, kFirstTwo);
  expect_correlation(0, 2, kFirstThird);
  expect_correlation(1, 2, kLastTwo);
}

// The standard error of Spearman's rank correlation is below 1.06 / sqrt(n).
TEST(NormalCopula, OtherErrorsHaveItsRankCorrelation) {
  const auto rows =
      draws_of({Distribution::measured(measured_values()), Distribution::triangular(3.0), Distribution::uniform(1.0)});
  const auto expect_rank_correlation = [&](std::size_t i, std::size_t j, double rho) {
    const double expected = 6.0 / std::numbers::pi * std::asin(0.5 * rho);
    EXPECT_LE(std::abs(rank_correlation(rows[i], rows[j]) - expected), kZ * 1.06 / std::sqrt(kDraws)) << i << j;
  };
  expect_rank_correlation(0, 1, kFirstTwo);
  expect_rank_correlation(0, 2, kFirstThird);
  expect_rank_correlation(1, 2, kLastTwo);
}

}  // namespace
}  // namespace poesy
