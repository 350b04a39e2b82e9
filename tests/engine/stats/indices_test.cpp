#include "engine/stats/indices.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace poesy {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kZ = 1.9599639845400542;  // normal quantile at 0.975

Moments moments_of(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

/// Moments of n values, half of them -1 and half +1: the variance is n / (n - 1), the kurtosis 1.
Moments two_points(std::size_t n) {
  Moments moments;
  for (std::size_t k = 0; k < n; ++k) moments.add(k % 2 == 0 ? -1.0 : 1.0);
  return moments;
}

void expect_unknown(const Interval& interval) {
  EXPECT_TRUE(std::isnan(interval.low));
  EXPECT_TRUE(std::isnan(interval.high));
}

TEST(LocalIndex, IsTheRatioOfStandardDeviations) {
  EXPECT_DOUBLE_EQ(local_index(moments_of({1, 2, 3, 4, 10}), 0.5, 0.95).value, std::sqrt(12.5) / 0.5);
}

TEST(LocalIndex, IntervalIsBonettsByHand) {
  // The interval of ln(variance) is ln(c s^2) +- z c sqrt((1 - 97/100) / 99), with c = 100 / (100 - z) and s^2 = 100 /
  // 99.
  const Estimate index = local_index(two_points(100), 2.0, 0.95);
  const double c = 100.0 / (100.0 - kZ);
  const double half = kZ * c * std::sqrt((1.0 - 0.97) / 99.0);
  const double centre = std::log(c * 100.0 / 99.0);
  EXPECT_DOUBLE_EQ(index.interval.low, std::exp(0.5 * (centre - half)) / 2.0);
  EXPECT_DOUBLE_EQ(index.interval.high, std::exp(0.5 * (centre + half)) / 2.0);
}

TEST(LocalIndex, ZeroSpreadIsCertain) {
  const Estimate index = local_index(moments_of({3, 3, 3}), 1.0, 0.95);
  EXPECT_EQ(index.value, 0.0);
  EXPECT_EQ(index.interval.low, 0.0);
  EXPECT_EQ(index.interval.high, 0.0);
}

TEST(LocalIndex, TooFewSamplesGiveNoInterval) {
  expect_unknown(local_index(moments_of({}), 1.0, 0.95).interval);
  expect_unknown(local_index(moments_of({1}), 1.0, 0.95).interval);
  EXPECT_TRUE(std::isnan(local_index(moments_of({1}), 1.0, 0.95).value));
  expect_unknown(local_index(moments_of({1, 2, 3, 4}), 1.0, 0.95).interval);
  EXPECT_GT(local_index(moments_of({1, 2, 3, 4, 6}), 1.0, 0.95).interval.high, 0.0);
}

TEST(LocalIndex, StandardErrorIsThatOfTheLogarithmTimesTheIndex) {
  const LocalIndex index = local_index_with_error(two_points(100), 2.0);
  EXPECT_DOUBLE_EQ(index.value, std::sqrt(100.0 / 99.0) / 2.0);
  // The difference 1 - 0.97 loses two digits.
  EXPECT_NEAR(index.standard_error, 0.5 * index.value * std::sqrt(0.03 / 99.0), 1e-13 * index.standard_error);
}

TEST(LocalIndex, StandardErrorIsZeroWithoutSpreadAndUnknownForFew) {
  EXPECT_EQ(local_index_with_error(moments_of({3, 3}), 1.0).standard_error, 0.0);
  EXPECT_TRUE(std::isnan(local_index_with_error(moments_of({1, 2, 3, 4}), 1.0).standard_error));
}

TEST(GlobalIndex, TwoPosesByHand) {
  const std::vector<LocalIndex> poses{{1.0, 0.0}, {4.0, 0.0}};
  const Estimate index = global_index(poses, 0.95);
  EXPECT_DOUBLE_EQ(index.value, 2.5 + 3.0 / std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(index.interval.low, index.value) << "no sampling noise, no doubt";
  EXPECT_DOUBLE_EQ(index.interval.high, index.value);
}

TEST(GlobalIndex, DividesTheSpreadByPosesMinusOne) {
  const std::vector<LocalIndex> poses{{1, 0}, {2, 0}, {3, 0}, {4, 0}, {10, 0}};
  EXPECT_DOUBLE_EQ(global_index(poses, 0.95).value, 4.0 + std::sqrt(12.5));
}

TEST(GlobalIndex, SinglePoseIsItsOwnMean) {
  const std::vector<LocalIndex> poses{{2.0, 0.1}};
  const Estimate index = global_index(poses, 0.95);
  EXPECT_EQ(index.value, 2.0);
  // The interval is centred on the index corrected for the bias of a standard deviation, v / (2 x) = 0.0025, with v =
  // 0.1^2 and x = 2.
  EXPECT_NEAR(index.interval.low, 2.0025 - kZ * 0.1, 1e-14);
  EXPECT_NEAR(index.interval.high, 2.0025 + kZ * 0.1, 1e-14);
}

TEST(GlobalIndex, AllZeroIsCertain) {
  const std::vector<LocalIndex> poses(20, {0.0, 0.0});
  const Estimate index = global_index(poses, 0.95);
  EXPECT_EQ(index.value, 0.0);
  EXPECT_EQ(index.interval.low, 0.0);
  EXPECT_EQ(index.interval.high, 0.0);
}

TEST(GlobalIndex, EqualIndicesWithNoiseAreTheMeanFromBelow) {
  // The observed spread is 0. The lower limit is that of the mean. The upper limit includes a spread that noise may
  // have hidden.
  const std::vector<LocalIndex> poses(4, {1.0, 0.01});
  const Interval interval = global_index(poses, 0.95).interval;
  const double mean = 1.0 + 0.5e-4;
  const double spread2 = -1e-4 + kZ * std::sqrt(2.0 * (4 * 1e-8 * 0.5 + 1e-8) / 9.0);
  EXPECT_NEAR(interval.low, mean - kZ * 0.005, 1e-14);
  EXPECT_NEAR(interval.high, mean + std::hypot(kZ * 0.005, std::sqrt(spread2)), 1e-14);
}

TEST(GlobalIndex, SpreadThatNoiseCouldMakeLeavesTheLowerLimitOfTheMean) {
  // Three poses with the standard error e. With noise alone, (spread / e)^2 is distributed like chi-square with 2
  // degrees of freedom, divided by 2; its 0.975 quantile is 3.689.
  constexpr double kError = 1e-3;
  const auto lower_limit = [](double seen2_over_noise2) {
    const double step = kError * std::sqrt(seen2_over_noise2);
    return global_index(std::vector<LocalIndex>{{1.0 - step, kError}, {1.0, kError}, {1.0 + step, kError}}, 0.95)
        .interval.low;
  };
  const double of_mean = 1.0 - kZ * kError / std::sqrt(3.0);
  EXPECT_NEAR(lower_limit(1.0), of_mean, 1e-6);
  EXPECT_NEAR(lower_limit(3.6), of_mean, 1e-6);
  EXPECT_GT(lower_limit(3.8), of_mean + 1e-4);
}

TEST(GlobalIndex, UnknownPoseMakesTheWholeUnknown) {
  const std::vector<LocalIndex> poses{{1.0, 0.1}, {kNaN, kNaN}, {2.0, 0.1}};
  EXPECT_TRUE(std::isnan(global_index(poses, 0.95).value));
  expect_unknown(global_index(poses, 0.95).interval);
}

TEST(GlobalIndex, UnknownStandardErrorMakesTheIntervalUnknown) {
  const std::vector<LocalIndex> poses{{1.0, kNaN}, {2.0, 0.1}};
  EXPECT_DOUBLE_EQ(global_index(poses, 0.95).value, 1.5 + std::sqrt(0.5));
  expect_unknown(global_index(poses, 0.95).interval);
}

TEST(GlobalIndex, NoPosesHaveNoIndex) {
  const Estimate index = global_index({}, 0.95);
  EXPECT_TRUE(std::isnan(index.value));
  expect_unknown(index.interval);
}

}  // namespace
}  // namespace poesy
