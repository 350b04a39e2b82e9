#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "engine/stats/indices.h"

namespace poesy {
namespace {

constexpr double kZ = 1.9599639845400542;  // normal quantile at 0.975

Moments skewed_response(double scale, std::size_t count) {
  std::mt19937_64 engine(5);
  std::exponential_distribution<double> draw;
  Moments moments;
  for (std::size_t k = 0; k < count; ++k) moments.add(scale * draw(engine));
  return moments;
}

/// Local indices that differ strongly between the poses, as do their standard errors.
std::vector<LocalIndex> different_poses(std::size_t count, double relative_error) {
  std::mt19937_64 engine(9);
  std::uniform_real_distribution<double> draw(0.2, 1.0);
  std::vector<LocalIndex> poses(count);
  for (LocalIndex& pose : poses) {
    pose.value = draw(engine);
    pose.standard_error = relative_error * draw(engine);
  }
  return poses;
}

double width(const Interval& interval) { return interval.high - interval.low; }

TEST(LocalIndexInterval, HoldsTheIndexAndShrinksWithSamples) {
  double last = 1e300;
  for (const std::size_t count : {std::size_t{10}, std::size_t{100}, std::size_t{1000}, std::size_t{10000}}) {
    const Estimate index = local_index(skewed_response(1.0, count), 1.0, 0.95);
    EXPECT_LT(index.interval.low, index.value);
    EXPECT_GT(index.interval.high, index.value);
    EXPECT_LT(width(index.interval), last);
    last = width(index.interval);
  }
}

TEST(LocalIndexInterval, GrowsWithTheLevel) {
  const Moments response = skewed_response(1.0, 1000);
  EXPECT_LT(width(local_index(response, 1.0, 0.5).interval), width(local_index(response, 1.0, 0.95).interval));
  EXPECT_LT(width(local_index(response, 1.0, 0.95).interval), width(local_index(response, 1.0, 0.999).interval));
}

TEST(LocalIndexInterval, ScalesWithResponseAndAgainstError) {
  const Estimate one = local_index(skewed_response(1.0, 200), 1.0, 0.95);
  const Estimate other = local_index(skewed_response(8.0, 200), 2.0, 0.95);
  EXPECT_DOUBLE_EQ(other.value, 4.0 * one.value);
  EXPECT_DOUBLE_EQ(other.interval.low, 4.0 * one.interval.low);
  EXPECT_DOUBLE_EQ(other.interval.high, 4.0 * one.interval.high);
}

TEST(LocalIndexInterval, AgreesWithTheStandardErrorOfMany) {
  const Moments response = skewed_response(1.0, 1000000);
  const LocalIndex index = local_index_with_error(response, 1.0);
  EXPECT_NEAR(width(local_index(response, 1.0, 0.95).interval), 2.0 * kZ * index.standard_error,
              0.01 * index.standard_error);
}

TEST(GlobalIndexInterval, TendsToErrorPropagationForSmallNoise) {
  // Error propagation for M poses: d(mean + spread) / d(x_i) = 1 / M + (x_i - mean) / ((M - 1) spread). The errors of
  // the x_i are independent.
  for (const std::size_t count : {std::size_t{2}, std::size_t{3}, std::size_t{20}, std::size_t{158}}) {
    const std::vector<LocalIndex> poses = different_poses(count, 1e-6);
    Moments over_poses;
    for (const LocalIndex& pose : poses) over_poses.add(pose.value);
    const auto m = static_cast<double>(count);
    double variance = 0.0;
    for (const LocalIndex& pose : poses) {
      const double slope = 1.0 / m + (pose.value - over_poses.mean()) / ((m - 1.0) * over_poses.standard_deviation());
      variance += std::pow(slope * pose.standard_error, 2);
    }
    const Estimate index = global_index(poses, 0.95);
    EXPECT_NEAR(index.interval.high - index.value, kZ * std::sqrt(variance), 1e-4 * std::sqrt(variance)) << count;
    EXPECT_NEAR(index.value - index.interval.low, kZ * std::sqrt(variance), 1e-4 * std::sqrt(variance)) << count;
  }
}

TEST(GlobalIndexInterval, DoesNotDependOnTheOrderOfPoses) {
  std::vector<LocalIndex> poses = different_poses(50, 0.05);
  const Estimate forward = global_index(poses, 0.95);
  std::reverse(poses.begin(), poses.end());
  const Estimate backward = global_index(poses, 0.95);
  EXPECT_NEAR(forward.value, backward.value, 1e-14);
  EXPECT_NEAR(forward.interval.low, backward.interval.low, 1e-14);
  EXPECT_NEAR(forward.interval.high, backward.interval.high, 1e-14);
}

TEST(GlobalIndexInterval, ScalesWithTheIndices) {
  for (const double relative_error : {1e-3, 0.05, 0.5}) {
    std::vector<LocalIndex> poses = different_poses(30, relative_error);
    const Estimate one = global_index(poses, 0.95);
    for (LocalIndex& pose : poses) pose = {pose.value * 0x1p-40, pose.standard_error * 0x1p-40};
    const Estimate other = global_index(poses, 0.95);
    EXPECT_EQ(other.value, one.value * 0x1p-40);
    EXPECT_EQ(other.interval.low, one.interval.low * 0x1p-40);
    EXPECT_EQ(other.interval.high, one.interval.high * 0x1p-40);
  }
}

TEST(GlobalIndexInterval, GrowsWithTheLevelAndTheNoise) {
  double last = 0.0;
  for (const double relative_error : {1e-4, 1e-3, 1e-2, 0.05}) {
    const std::vector<LocalIndex> poses = different_poses(30, relative_error);
    const double at_95 = width(global_index(poses, 0.95).interval);
    EXPECT_GT(at_95, last);
    EXPECT_LT(at_95, width(global_index(poses, 0.99).interval));
    last = at_95;
  }
}

TEST(GlobalIndexInterval, IsOrderedAndNotNegativeInAnyNoise) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{5}, std::size_t{158}}) {
    for (const double relative_error : {0.0, 1e-9, 1e-3, 0.1, 1.0, 100.0}) {
      const Estimate index = global_index(different_poses(count, relative_error), 0.95);
      EXPECT_GE(index.interval.low, 0.0) << count << " poses, noise " << relative_error;
      EXPECT_LE(index.interval.low, index.interval.high) << count << " poses, noise " << relative_error;
      EXPECT_TRUE(std::isfinite(index.interval.high)) << count << " poses, noise " << relative_error;
    }
  }
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Extreme lists of local indices, and a hundred random ones.
std::vector<std::vector<LocalIndex>> lists_of_poses() {
  std::vector<std::vector<LocalIndex>> lists{{{0.7, 0.1}},
                                             {{0.7, 0.0}},
                                             {{0.0, 0.0}},
                                             {{0.0, 0.0}, {0.0, 0.0}},
                                             {{0.0, 0.0}, {0.3, 0.1}},
                                             {{1.0, 0.2}, {1.0, 0.2}},
                                             {{1.0, 0.2}, {1.05, 0.2}, {0.97, 0.2}},
                                             {{0.1, 1e-9}, {5.0, 1e-9}},
                                             {{1e-9, 2e-9}, {1.0, 0.1}}};
  std::mt19937_64 engine(23);
  std::uniform_real_distribution<double> exponent(-8.0, 0.5);
  for (int k = 0; k < 100; ++k) {
    const double spread = std::pow(10.0, exponent(engine));
    const double noise = std::pow(10.0, exponent(engine));
    std::normal_distribution<double> draw(1.0, spread);
    std::vector<LocalIndex> poses(static_cast<std::size_t>(1 + k % 13));
    for (LocalIndex& pose : poses) pose = {std::abs(draw(engine)), noise};
    lists.push_back(std::move(poses));
  }
  return lists;
}

TEST(CorrectedGlobalIndex, IsWithinItsInterval) {
  for (const std::vector<LocalIndex>& poses : lists_of_poses()) {
    for (const double level : {0.01, 0.5, 0.95, 0.999}) {
      const Estimate index = corrected_global_index(poses, level);
      EXPECT_GE(index.interval.low, 0.0);
      EXPECT_LE(index.interval.low, index.value) << poses.size() << " poses, level " << level;
      EXPECT_LE(index.value, index.interval.high) << poses.size() << " poses, level " << level;
    }
  }
}

TEST(CorrectedGlobalIndex, HasThePublishedIntervalUnextended) {
  for (const std::vector<LocalIndex>& poses : lists_of_poses()) {
    const Estimate published = global_index(poses, 0.95);
    const Estimate corrected = corrected_global_index(poses, 0.95);
    EXPECT_EQ(corrected.interval.low, published.interval.low);
    EXPECT_EQ(std::max(corrected.interval.high, published.value), published.interval.high);
  }
}

TEST(CorrectedGlobalIndex, IsMeanPlusSpreadWithoutNoise) {
  const std::vector<LocalIndex> exact{{0.2, 0.0}, {0.5, 0.0}, {1.1, 0.0}};
  EXPECT_NEAR(corrected_global_index(exact, 0.95).value, 0.6 + std::sqrt((0.16 + 0.01 + 0.25) / 2.0), 1e-15);
  // Without the bias of a standard deviation the indices are 1.005 and 2.0025. Their mean is 1.50375 and their variance
  // 0.9975^2 / 2, of which 0.01 is noise.
  const std::vector<LocalIndex> noisy{{1.0, 0.1}, {2.0, 0.1}};
  EXPECT_NEAR(corrected_global_index(noisy, 0.95).value, 1.50375 + std::sqrt(0.9975 * 0.9975 / 2.0 - 0.01), 1e-14);
}

TEST(CorrectedGlobalIndex, IsThePublishedOneIfNoiseIsUnknown) {
  const std::vector<LocalIndex> few{{1.0, kNaN}, {2.0, 0.1}};
  EXPECT_EQ(corrected_global_index(few, 0.95).value, global_index(few, 0.95).value);
  EXPECT_TRUE(std::isnan(corrected_global_index(few, 0.95).interval.low));
  const std::vector<LocalIndex> unknown{{kNaN, kNaN}, {2.0, 0.1}};
  EXPECT_TRUE(std::isnan(corrected_global_index(unknown, 0.95).value));
  EXPECT_TRUE(std::isnan(corrected_global_index(unknown, 0.95).interval.high));
  EXPECT_TRUE(std::isnan(corrected_global_index({}, 0.95).value));
}

}  // namespace
}  // namespace poesy
