#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "engine/random/distribution.h"
#include "engine/random/weighted_points.h"

namespace poesy {
namespace {

constexpr double kMean = -0.4;

std::vector<Distribution> about_zero() {
  return {Distribution::normal(1.0), Distribution::truncated_normal(1.0, 0.5), Distribution::uniform(0.7),
          Distribution::triangular(0.7), Distribution::uniform(0.7).shifted(0.2)};
}

TEST(DistributionAboutAMean, HasItsValuesMoved) {
  for (const Distribution& plain : about_zero()) {
    const Distribution moved = plain.about(kMean);
    EXPECT_EQ(moved.mean(), kMean);
    EXPECT_EQ(moved.centre(), kMean);
    EXPECT_EQ(moved.standard_deviation(), plain.standard_deviation());
    EXPECT_EQ(moved.half_width(), plain.half_width());
    EXPECT_EQ(moved.largest(), plain.largest() - kMean);
    std::vector<double> draws;
    for (int k = 0; k < 1201; ++k) draws.push_back((k + 0.5) / 1201.0);
    std::vector<double> moved_draws = draws;
    moved.transform(moved_draws);
    for (std::size_t k = 0; k < draws.size(); ++k) {
      EXPECT_EQ(moved.quantile(draws[k]), plain.quantile(draws[k]) + kMean);
      EXPECT_EQ(moved_draws[k], moved.quantile(draws[k]));
    }
    std::vector<double> scores{-2.0, 0.3};
    std::vector<double> moved_scores = scores;
    plain.transform_scores(scores);
    moved.transform_scores(moved_scores);
    for (std::size_t k = 0; k < scores.size(); ++k) EXPECT_EQ(moved_scores[k], scores[k] + kMean);
    EXPECT_NE(moved, plain);
  }
}

TEST(DistributionAboutAMean, IsTheSameAboutZero) {
  for (const Distribution& plain : about_zero()) EXPECT_EQ(plain.about(0.0), plain);
}

TEST(DistributionAboutAMean, HasItsWeightedPointsMoved) {
  for (const Distribution& plain : {Distribution::uniform(0.7), Distribution::triangular(0.7)}) {
    const WeightedPoints at_zero = weighted_points(plain);
    const WeightedPoints moved = weighted_points(plain.about(kMean));
    EXPECT_EQ(moved.weights, at_zero.weights);
    for (std::size_t k = 0; k < moved.points.size(); ++k) {
      EXPECT_NEAR(moved.points[k], at_zero.points[k] + kMean, 1e-15);
    }
  }
}

TEST(DistributionAboutAMean, RefusesWhatMakesNoSense) {
  EXPECT_THROW(Distribution::normal(1.0).about(std::numeric_limits<double>::infinity()), std::invalid_argument);
  EXPECT_THROW(Distribution::normal(1.0).about(std::nan("")), std::invalid_argument);
  EXPECT_THROW(Distribution::measured({1, 2, 3, 4, 5, 6, 7, 8}).about(0.1), std::invalid_argument);
  EXPECT_THROW(Distribution::given({1, 2}).about(0.1), std::invalid_argument);
  EXPECT_THROW(Distribution::given({1, 2}).shifted(0.1), std::invalid_argument);
}

TEST(GivenValues, AreEquallyLikely) {
  const Distribution given = Distribution::given({3.0, -1.0, 2.0, 2.0});
  EXPECT_EQ(given.mean(), 1.5);
  EXPECT_DOUBLE_EQ(given.standard_deviation(), std::sqrt((2.25 + 6.25 + 0.25 + 0.25) / 3.0));
  EXPECT_EQ(given.largest(), 3.0);
  std::vector<double> draws{1e-9, 0.2, 0.3, 0.5, 0.7, 0.75, 1.0 - 0x1p-53};
  const std::vector<double> expected{-1.0, -1.0, 2.0, 2.0, 2.0, 3.0, 3.0};
  for (std::size_t k = 0; k < draws.size(); ++k) EXPECT_EQ(given.quantile(draws[k]), expected[k]);
  given.transform(draws);
  EXPECT_EQ(draws, expected);
  EXPECT_NE(given, Distribution::given({3.0, -1.0, 2.0, 1.0}));
}

TEST(GivenValues, AreRefusedWhereTheyMakeNoSense) {
  EXPECT_THROW(Distribution::given({1.0}), std::invalid_argument);
  EXPECT_THROW(Distribution::given({1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(Distribution::given({1.0, std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace poesy
