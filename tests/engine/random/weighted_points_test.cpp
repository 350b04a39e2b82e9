#include "engine/random/weighted_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

namespace poesy {
namespace {

/// Compares the moments of x / half_width over the weighted points with a formula, for all degrees that must be exact.
/// expected(k): the moment of degree k.
void expect_moments(const Distribution& distribution, const std::function<double(int)>& expected) {
  const auto [points, weights] = weighted_points(distribution);
  for (int k = 0; k <= static_cast<int>(kExactDegree); ++k) {
    double mean = 0.0;
    for (std::size_t n = 0; n < points.size(); ++n) {
      EXPECT_GT(weights[n], 0.0);
      mean += weights[n] * std::pow(points[n] / distribution.half_width(), k);
    }
    EXPECT_NEAR(mean, expected(k), 1e-15) << k;
  }
}

TEST(WeightedPoints, HaveTheMomentsOfTheUniform) {
  expect_moments(Distribution::uniform(2e-4), [](int k) { return k % 2 == 0 ? 1.0 / (k + 1) : 0.0; });
}

TEST(WeightedPoints, HaveTheMomentsOfTheTriangular) {
  expect_moments(Distribution::triangular(3.0), [](int k) { return k % 2 == 0 ? 2.0 / ((k + 1) * (k + 2)) : 0.0; });
}

TEST(WeightedPoints, HaveTheMomentsOfMeasuredValuesWithTies) {
  const std::vector<double> values{-0.5, -0.25, -0.25, -0.25, 0.0, 0.125, 0.75, 1.0};
  const Distribution measured = Distribution::measured(values);
  const double w = measured.half_width();
  expect_moments(measured, [&](int k) {
    double sum = 0.0;
    for (std::size_t n = 0; n < values.size(); ++n) {
      const double a = (values[n] - measured.parts()->half_widths()[n]) / w;
      const double b = (values[n] + measured.parts()->half_widths()[n]) / w;
      sum += a == b ? std::pow(a, k) : (std::pow(b, k + 1) - std::pow(a, k + 1)) / ((k + 1) * (b - a));
    }
    return sum / static_cast<double>(values.size());
  });
}

TEST(WeightedPoints, AreRefusedForADensityThatIsNotLinearInPieces) {
  EXPECT_THROW(weighted_points(Distribution::normal(1e-4)), std::logic_error);
  EXPECT_THROW(weighted_points(Distribution::truncated_normal(1e-4, 3e-4)), std::logic_error);
}

}  // namespace
}  // namespace poesy
