#include "engine/kinds/monte_carlo/part_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "engine/random/normal_copula.h"
#include "engine/random/normal_quantile.h"

namespace poesy::monte_carlo {
namespace {

using Columns = std::vector<std::vector<double>>;

/// The density of two measured errors, computed from its definition. Each measured part has a weight, and its value is
/// spread evenly over its range. A Gaussian copula with the correlation of the weighted ranks joins the two errors.
class WeightedParts {
 public:
  WeightedParts(const std::vector<SmoothedValues>& parts, std::vector<double> weights)
      : parts_(parts), weights_(std::move(weights)) {}

  double share(std::size_t p, double x) const {
    return sum([&](std::size_t i) { return std::clamp((x - low(p, i)) / (high(p, i) - low(p, i)), 0.0, 1.0); });
  }
  double density(std::size_t p, double x) const {
    return sum([&](std::size_t i) { return low(p, i) <= x && x <= high(p, i) ? 1.0 / (high(p, i) - low(p, i)) : 0.0; });
  }
  double correlation() const {
    const auto grade = [&](std::size_t p, std::size_t j) {
      return sum([&](std::size_t i) {
        return parts_[p].values()[i] < parts_[p].values()[j] ? 1.0 : i == j ? 0.5 : 0.0;
      });
    };
    std::array<double, 5> moments{};
    for (std::size_t j = 0; j < weights_.size(); ++j) {
      const double a = grade(0, j) - 0.5;
      const double b = grade(1, j) - 0.5;
      const std::array products{a, b, a * a, b * b, a * b};
      for (std::size_t k = 0; k < 5; ++k) moments[k] += weights_[j] * products[k];
    }
    const double rank = (moments[4] - moments[0] * moments[1]) /
                        std::sqrt((moments[2] - moments[0] * moments[0]) * (moments[3] - moments[1] * moments[1]));
    return 2.0 * std::sin(std::numbers::pi / 6.0 * rank);
  }
  /// The logarithm of the joint density of two errors x with the copula correlation rho.
  double log_density(const std::array<double, 2>& x, double rho) const {
    std::array<double, 2> z{};
    double sum = 0.0;
    for (std::size_t p = 0; p < 2; ++p) {
      z[p] = normal_quantile(1.0, share(p, x[p]));
      sum += std::log(density(p, x[p])) + 0.5 * z[p] * z[p];
    }
    const double rest = 1.0 - rho * rho;
    return sum - 0.5 * (z[0] * z[0] - 2.0 * rho * z[0] * z[1] + z[1] * z[1]) / rest - 0.5 * std::log(rest);
  }

 private:
  double low(std::size_t p, std::size_t i) const { return parts_[p].values()[i] - parts_[p].half_widths()[i]; }
  double high(std::size_t p, std::size_t i) const { return parts_[p].values()[i] + parts_[p].half_widths()[i]; }
  template <class Term>
  double sum(const Term& term) const {
    double total = 0.0;
    for (std::size_t i = 0; i < weights_.size(); ++i) total += weights_[i] * term(i);
    return total;
  }

  const std::vector<SmoothedValues>& parts_;
  std::vector<double> weights_;
};

/// Two errors measured on twelve parts, with a positive correlation.
std::vector<SmoothedValues> twelve() {
  return {SmoothedValues({0.1, -0.4, 0.9, 1.7, -1.2, 0.3, -0.7, 0.5, -2.1, 1.1, -0.2, 0.8}),
          SmoothedValues({0.4, -0.9, 0.2, 2.3, -1.4, -0.3, 0.1, 1.5, -1.1, 0.6, -1.8, 0.7})};
}

/// Weights 1 / n, mixed with the share `step` of all weight on one part. The sum is 1.
std::vector<double> weights(std::size_t n, std::size_t part, double step) {
  std::vector<double> found(n, (1.0 - step) / static_cast<double>(n));
  found[part] += step;
  return found;
}

template <class LogDensity>
double slope(std::size_t n, std::size_t part, const LogDensity& log_density) {
  constexpr double kStep = 1e-5;
  return (log_density(weights(n, part, kStep)) - log_density(weights(n, part, -kStep))) / (2.0 * kStep);
}

TEST(PartGroup, KnowsHowPartsWeighInOneError) {
  const std::vector<SmoothedValues> parts = twelve();
  const PartGroup group = part_group({0}, {parts[0]}, {});
  for (const double x : {-2.5, -1.05, -0.21, 0.33, 0.87, 1.95}) {
    std::vector<double> influence(12, 0.0);
    add_influence(group, std::array{x}, influence);
    EXPECT_NEAR(std::accumulate(influence.begin(), influence.end(), 0.0), 0.0, 1e-12);
    for (std::size_t i = 0; i < 12; ++i) {
      const double expected =
          slope(12, i, [&](const std::vector<double>& w) { return std::log(WeightedParts(parts, w).density(0, x)); });
      EXPECT_NEAR(influence[i], expected, 1e-6 * (1.0 + std::abs(expected))) << x << ' ' << i;
    }
  }
}

/// Compares the influence of each part on the log density of two errors with finite differences. own: whether the
/// correlation is that of the parts; otherwise it is fixed.
void expect_block(bool own) {
  const std::vector<SmoothedValues> parts = twelve();
  const WeightedParts even(parts, std::vector<double>(12, 1.0 / 12.0));
  const double rho = own ? even.correlation() : 0.3;
  const PartGroup group = part_group({0, 1}, parts, std::array{1.0, rho, rho, 1.0});
  EXPECT_EQ(group.moves.empty(), !own);
  for (const std::array x : {std::array{-0.41, 0.22}, std::array{1.6, -1.3}, std::array{0.95, 1.9}}) {
    std::vector<double> influence(12, 0.0);
    add_influence(group, x, influence);
    EXPECT_NEAR(std::accumulate(influence.begin(), influence.end(), 0.0), 0.0, 1e-10);
    for (std::size_t i = 0; i < 12; ++i) {
      const double expected = slope(12, i, [&](const std::vector<double>& w) {
        const WeightedParts weighted(parts, w);
        return weighted.log_density(x, own ? weighted.correlation() : rho);
      });
      EXPECT_NEAR(influence[i], expected, 1e-5 * (1.0 + std::abs(expected))) << x[0] << ' ' << i;
    }
  }
}

TEST(PartGroup, KnowsHowPartsWeighInErrorsOfAStatedCorrelation) { expect_block(false); }

TEST(PartGroup, KnowsHowPartsWeighInTheirCorrelation) { expect_block(true); }

/// Equal values are not spread over a range. Their probability is the sum of their weights.
TEST(PartGroup, CountsEqualValues) {
  const SmoothedValues parts({0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0});
  const PartGroup group = part_group({0}, {parts}, {});
  std::vector<double> influence(10, 0.0);
  add_influence(group, std::array{1.0}, influence);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_DOUBLE_EQ(influence[i], i < 4 ? -1.0 : 10.0 / 6.0 - 1.0);
}

}  // namespace
}  // namespace poesy::monte_carlo
