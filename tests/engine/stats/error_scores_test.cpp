#include "engine/stats/error_scores.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "engine/random/normal_copula.h"
#include "engine/random/weighted_points.h"
#include "tests/engine/stats/yield_cases.h"

namespace poesy {
namespace {

double mean_of(const WeightedPoints& points, const std::function<double(double)>& function) {
  double sum = 0.0;
  for (std::size_t n = 0; n < points.points.size(); ++n) sum += points.weights[n] * function(points.points[n]);
  return sum;
}

TEST(PolynomialScore, OfTheUniformIsASumOfLegendrePolynomials) {
  constexpr double kHalf = 2e-4;
  const WeightedPoints points = weighted_points(Distribution::uniform(kHalf));
  const PolynomialScore score(points.points, points.weights);
  EXPECT_NEAR(score.sigma(), kHalf / std::numbers::sqrt3, 1e-15 * kHalf);
  EXPECT_NEAR(score.moments().square, 5.0 + 9.0 + 13.0, 1e-12);
  EXPECT_NEAR(score.moments().cube, mean_of(points, [&](double e) { return std::pow(score(e), 3); }), 1e-11);
  for (const double u : {-1.0, -0.7, -0.1, 0.0, 0.3, 0.95, 1.0}) {
    const double expected = 5.0 * std::legendre(2, u) + 9.0 * std::legendre(4, u) + 13.0 * std::legendre(6, u);
    EXPECT_NEAR(score(u * kHalf), expected, 1e-12) << u;
  }
}

TEST(PolynomialScore, OfALowerDegreeIsItsBeginning) {
  const WeightedPoints points = weighted_points(Distribution::uniform(2.0));
  const PolynomialScore six(points.points, points.weights);
  const PolynomialScore two(points.points, points.weights, 2);
  for (const double e : {-1.9, 0.3, 2.0}) {
    EXPECT_NEAR(two(e), 5.0 * std::legendre(2, 0.5 * std::abs(e)), 1e-13);
    EXPECT_EQ(two(e), six.parabola(e));
    EXPECT_NEAR(two.growth(e), 0.5 * (kErrorGrowth * kErrorGrowth - 1.0) * two(e), 1e-13);
  }
  EXPECT_NEAR(two.moments().square, 5.0, 1e-13);
}

TEST(PolynomialScore, OfANormalIsTheExactOne) {
  WeightedPoints points;  // the trapezoidal rule, exact to double precision here
  for (int k = -240; k <= 240; ++k) {
    const double z = 0.05 * k;
    points.points.push_back(3.0 * z);
    points.weights.push_back(0.05 * std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi));
  }
  const PolynomialScore score(points.points, points.weights);
  EXPECT_NEAR(score.sigma(), 3.0, 1e-13);
  for (const double z : {-4.0, -1.0, 0.0, 0.5, 3.0}) EXPECT_NEAR(score(3.0 * z), z * z - 1.0, 1e-9) << z;
}

/// Expects the defining equations of the score S for the powers q = ((e - c) / t)^k up to `degree`, with the mean c and
/// the standard deviation t: E[S q] = E[q'(e) (e - c)], and for the growth score E[q(c + g (e - c))] - E[q].
void expect_score(const WeightedPoints& points, int degree) {
  const PolynomialScore score(points.points, points.weights);
  const double centre = mean_of(points, [](double e) { return e; });
  const auto z = [&](double e) { return (e - centre) / score.sigma(); };
  EXPECT_NEAR(mean_of(points, [&](double e) { return z(e) * z(e); }), 1.0, 1e-13);
  for (int k = 0; k <= degree; ++k) {
    const double expected = k * mean_of(points, [&](double e) { return std::pow(z(e), k); });
    const double size = mean_of(points, [&](double e) { return std::abs(score(e) * std::pow(z(e), k)); });
    EXPECT_NEAR(mean_of(points, [&](double e) { return score(e) * std::pow(z(e), k); }), expected, 1e-10 * size) << k;
    const double grown =
        (std::pow(kErrorGrowth, k) - 1.0) * mean_of(points, [&](double e) { return std::pow(z(e), k); });
    EXPECT_NEAR(mean_of(points, [&](double e) { return score.growth(e) * std::pow(z(e), k); }), grown, 1e-10 * size)
        << k;
  }
}

TEST(PolynomialScore, IsExactUpToItsDegree) {
  constexpr int kDegree = PolynomialScore::kDegree;
  expect_score(weighted_points(Distribution::triangular(1e-3)), kDegree);
  const std::vector<double> skewed{-0.3, -0.29, -0.25, -0.2, -0.2, -0.1, 0.0, 0.2, 0.6, 1.4};
  expect_score(weighted_points(Distribution::measured(skewed)), kDegree);
  expect_score(weighted_points(Distribution::measured({0, 0, 0, 0, 1, 1, 1, 1, 1, 1})), kDegree);
  expect_score(weighted_points(Distribution::measured({0, .1, .2, .3, .4, .5, .6, 1000})), kDegree);
}

TEST(PolynomialScore, OfThreePointsIsAParabola) {
  const WeightedPoints points{{-1.0, 0.5, 2.0, 0.5}, {0.25, 0.25, 0.25, 0.25}};
  expect_score(points, 2);
  const PolynomialScore score(points.points, points.weights);
  EXPECT_NEAR(score(3.0) - 3.0 * score(1.0) + 3.0 * score(-1.0) - score(-3.0), 0.0, 1e-12);
}

/// The relative errors of the gradient by a uniform error that theory.md states. others: standard deviation of the
/// other, normal errors; the smaller it is, the more of the rejects the uniform error causes alone.
TEST(PolynomialScore, LeavesOutWhatIsStated) {
  const Distribution uniform = Distribution::uniform(1.0);
  const WeightedPoints points = weighted_points(uniform);
  const PolynomialScore score(points.points, points.weights);
  const auto bias = [&](double others, double limit) {
    double estimate = 0.0;
    const auto given = [&](double e) {
      const double scale = others * std::numbers::sqrt2;
      return 0.5 * (std::erf((limit - e) / scale) + std::erf((limit + e) / scale));
    };
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double e = uniform.quantile((k + 0.5) / kSteps);
      estimate += score(e) * given(e) / kSteps;
    }
    const double truth =
        test::slope_at(1.0, [&](double size) { return test::share_of_uniform(-size, size, others, limit); });
    return estimate / truth - 1.0;
  };
  EXPECT_NEAR(bias(0.05, 0.9023), 0.25, 0.02);
  EXPECT_NEAR(bias(0.1, 0.9131), 0.14, 0.02);
  EXPECT_NEAR(bias(0.2, 0.9699), 0.05, 0.01);
  EXPECT_NEAR(bias(0.3, 1.05), 0.01, 0.01);
  EXPECT_NEAR(bias(0.5, 1.3), 0.0, 0.005);
}

TEST(NormalScore, OfACutOffNormalHasTheEnds) {
  EXPECT_EQ((NormalScore{2.0, std::numeric_limits<double>::infinity()}.ends()), 0.0);
  // ends() is the derivative by ln t of -ln(2 Phi(w / t) - 1), with the half-width w = 3 and t = 2.
  const double slope = test::slope_at(2.0, [](double t) { return -std::log(std::erf(3.0 / t / std::numbers::sqrt2)); });
  EXPECT_NEAR((NormalScore{2.0, 3.0}.ends()), 2.0 * slope, 1e-9);
}

TEST(ScoreMoments, AreThoseOfTheScores) {
  // The score of a single normal error in a block is z^2 - 1.
  const ScoreMoments alone = score_moments({{BlockScore{2.0}}, {{{0}, {1.0}}}}, 0);
  EXPECT_DOUBLE_EQ(alone.square, 2.0);
  EXPECT_DOUBLE_EQ(alone.cube, 8.0);
  // Two errors with the correlation 0.6, so that (R^-1)_ii = 1 / 0.64. The moments are integrated by the trapezoidal
  // rule over independent normals.
  const ErrorScores two{{ErrorScore(), BlockScore{1.0}, BlockScore{1.0}},
                        {{{2, 1}, lower_triangle(std::array{1.0, 0.6, 0.6, 1.0})}}};
  ScoreMoments sums{0.0, 0.0};
  for (int i = -100; i <= 100; ++i) {
    for (int j = -100; j <= 100; ++j) {
      const double u = 0.1 * i;
      const double v = 0.1 * j;
      std::array z{u, 0.6 * u + 0.8 * v};
      two.blocks[0].replace(z);
      const double weight = 0.01 * std::exp(-0.5 * (u * u + v * v)) / (2.0 * std::numbers::pi);
      sums.square += weight * z[0] * z[0];
      sums.cube += weight * z[0] * z[0] * z[0];
    }
  }
  EXPECT_NEAR(score_moments(two, 2).square, sums.square, 1e-9);
  EXPECT_NEAR(score_moments(two, 2).cube, sums.cube, 1e-9);
  EXPECT_NEAR(score_moments(two, 1).square, 1.0 + 1.0 / 0.64, 1e-12);
}

TEST(NormalBlock, HasTheScoreOfTheDensity) {
  const Eigen::Matrix3d correlation{{1.0, 0.6, -0.3}, {0.6, 1.0, 0.2}, {-0.3, 0.2, 1.0}};
  const Eigen::Matrix3d precision = correlation.inverse();
  const std::array sigma{0.5, 2.0, 3.0};
  const std::array error{0.7, -1.5, 4.0};
  const auto log_density = [&](std::size_t i, double other) {
    std::array t = sigma;
    t[i] = other;
    const Eigen::Vector3d z{error[0] / t[0], error[1] / t[1], error[2] / t[2]};
    return -0.5 * z.dot(precision * z) - std::log(t[i]);
  };
  const NormalBlock block{{0, 1, 2}, lower_triangle(std::span(correlation.data(), 9))};
  std::array scores{error[0] / sigma[0], error[1] / sigma[1], error[2] / sigma[2]};
  block.replace(scores);
  for (std::size_t i = 0; i < 3; ++i) {
    const double slope = test::slope_at(sigma[i], [&](double other) { return log_density(i, other); });
    EXPECT_NEAR(scores[i], slope * sigma[i], 1e-8) << i;
  }
}

}  // namespace
}  // namespace poesy
