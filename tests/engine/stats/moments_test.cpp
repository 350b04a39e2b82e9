#include "engine/stats/moments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/engine/stats/two_pass.h"

namespace poesy {
namespace {

Moments moments_of(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

TEST(Moments, NothingHasNoMoments) {
  const Moments none;
  EXPECT_EQ(none.count(), 0U);
  EXPECT_TRUE(std::isnan(none.variance()));
  EXPECT_TRUE(std::isnan(none.standard_deviation()));
  EXPECT_TRUE(std::isnan(none.kurtosis()));
}

TEST(Moments, OneValueHasAMeanOnly) {
  const Moments one = moments_of({2.5});
  EXPECT_EQ(one.count(), 1U);
  EXPECT_EQ(one.mean(), 2.5);
  EXPECT_TRUE(std::isnan(one.variance()));
  EXPECT_TRUE(std::isnan(one.kurtosis()));
}

TEST(Moments, SmallWholeNumbersByHand) {
  const Moments moments = moments_of({1, 2, 3, 4, 10});
  EXPECT_EQ(moments.count(), 5U);
  EXPECT_DOUBLE_EQ(moments.mean(), 4.0);
  EXPECT_DOUBLE_EQ(moments.variance(), 12.5);
  EXPECT_DOUBLE_EQ(moments.standard_deviation(), std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(moments.kurtosis(), 5.0 * (81 + 16 + 1 + 0 + 1296) / 2500.0);
}

TEST(Moments, EqualValuesHaveExactlyNoSpread) {
  const Moments moments = moments_of(std::vector<double>(1000, 0.1));
  EXPECT_EQ(moments.mean(), 0.1);
  EXPECT_EQ(moments.variance(), 0.0);
  EXPECT_TRUE(std::isnan(moments.kurtosis()));
}

TEST(Moments, TwoValuesHaveTheLeastKurtosis) { EXPECT_DOUBLE_EQ(moments_of({-1.0, 5.0}).kurtosis(), 1.0); }

/// Compares the moments of 10000 exponential draws with a two-pass computation. Rounding errors grow with offset /
/// scale.
void expect_two_pass_moments(double offset, double scale, double tolerance) {
  std::mt19937_64 engine(7);
  std::exponential_distribution<double> draw;
  std::vector<double> values;
  for (int k = 0; k < 10000; ++k) values.push_back(offset + scale * draw(engine));
  const Moments moments = moments_of(values);
  const test::TwoPass truth = test::two_pass(values);
  EXPECT_NEAR(moments.mean(), truth.mean, 1e-13 * (std::abs(truth.mean) + scale));
  EXPECT_NEAR(moments.variance(), truth.variance, tolerance * truth.variance);
  EXPECT_NEAR(moments.kurtosis(), truth.kurtosis, tolerance * truth.kurtosis);
}

TEST(Moments, AgreeWithTwoPasses) {
  expect_two_pass_moments(0.0, 1.0, 1e-12);
  expect_two_pass_moments(-5.0, 1.0, 1e-12);
  expect_two_pass_moments(1.0, 1e6, 1e-12);
}

TEST(Moments, AgreeWithTwoPassesUnderALargeOffset) { expect_two_pass_moments(1e6, 1.0, 1e-10); }

TEST(Moments, AgreeWithTwoPassesForTinyValues) {
  expect_two_pass_moments(0.0, 1e-20, 1e-12);
  expect_two_pass_moments(0.0, 1e-70, 1e-12);
}

TEST(Moments, KurtosisSurvivesVarianceWhoseSquareUnderflows) {
  EXPECT_NEAR(moments_of({1e-60, -1e-60, 3e-60, 0.0}).kurtosis(), moments_of({1.0, -1.0, 3.0, 0.0}).kurtosis(), 1e-12);
}

}  // namespace
}  // namespace poesy
