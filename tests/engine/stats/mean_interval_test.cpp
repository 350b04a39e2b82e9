#include "engine/stats/moments.h"

#include <gtest/gtest.h>

#include <cmath>

namespace poesy {
namespace {

Moments of(const std::vector<double>& values) { return Moments::of(values); }

TEST(MeanInterval, IsStudents) {
  // Values from tables of Student's t: at 95 %, 2.776445 for 4 degrees of freedom and 12.706205 for one; at 99 %,
  // 4.604095 for 4.
  const Moments five = of({1.0, 2.0, 3.0, 4.0, 5.0});
  const double error = std::sqrt(2.5 / 5.0);
  const Interval usual = mean_interval(five, 0.95);
  EXPECT_NEAR(usual.low, 3.0 - 2.776445 * error, 1e-6);
  EXPECT_NEAR(usual.high, 3.0 + 2.776445 * error, 1e-6);
  EXPECT_NEAR(mean_interval(five, 0.99).high, 3.0 + 4.604095 * error, 1e-6);
  EXPECT_NEAR(mean_interval(of({-1.0, 1.0}), 0.95).high, 12.706205, 1e-5);
}

TEST(MeanInterval, IsTheSameOfManyOneByOne) {
  MeanIntervals intervals(0.9);
  for (const std::vector<double>& values :
       {std::vector{1.0, 2.0, 4.0}, {2.0, 3.0, 7.0}, {1.0}, {5.0, 6.0}, {1.0, 2.0, 4.0, 8.0}, {1.0, 2.0, 4.0}}) {
    const Interval each = intervals.of(of(values));
    const Interval alone = mean_interval(of(values), 0.9);
    EXPECT_TRUE(each.low == alone.low || values.size() == 1) << values.size();
    EXPECT_TRUE(each.high == alone.high || values.size() == 1) << values.size();
    EXPECT_EQ(std::isnan(each.low), values.size() == 1);
  }
}

TEST(MeanInterval, IsAPointWithoutSpread) {
  const Interval interval = mean_interval(of({7.0, 7.0, 7.0}), 0.95);
  EXPECT_EQ(interval.low, 7.0);
  EXPECT_EQ(interval.high, 7.0);
}

TEST(MeanInterval, IsUnknownBelowTwoSamples) {
  for (const Moments& moments : {Moments(), of({1.0})}) {
    EXPECT_TRUE(std::isnan(mean_interval(moments, 0.95).low));
    EXPECT_TRUE(std::isnan(mean_interval(moments, 0.95).high));
  }
}

/// Three groups with numbers that are easy to check by hand.
struct ThreeGroups {
  std::vector<std::uint64_t> count{4, 9, 25};
  std::vector<double> mean{1.0, 2.0, 4.0};
  std::vector<double> std{2.0, 3.0, 5.0};
  operator Groups() const { return {count, mean, std}; }
};

TEST(StratifiedMean, AddsTheVarianceWithinGroups) {
  const Estimate found = stratified_mean(ThreeGroups(), 0.95);
  EXPECT_DOUBLE_EQ(found.value, (4.0 + 18.0 + 100.0) / 38.0);
  // Degrees of freedom by Satterthwaite: 722^2 / (16^2/3 + 81^2/8 + 625^2/24) = 30.34. Student's t for them is 2.0413.
  const double half = 2.0413 * std::sqrt(16.0 + 81.0 + 625.0) / 38.0;
  EXPECT_NEAR(found.interval.high - found.value, half, 1e-4 * half);
  EXPECT_NEAR(found.value - found.interval.low, half, 1e-4 * half);
}

TEST(StratifiedMean, OfOneGroupIsStudents) {
  const Moments five = of({1.0, 2.0, 3.0, 4.0, 5.0});
  ThreeGroups groups{{5, 0}, {five.mean(), std::nan("")}, {five.standard_deviation(), std::nan("")}};
  const Estimate found = stratified_mean(groups, 0.99);
  EXPECT_DOUBLE_EQ(found.value, 3.0);
  EXPECT_DOUBLE_EQ(found.interval.low, mean_interval(five, 0.99).low);
}

TEST(StratifiedMean, IsUnknownWhereASpreadIs) {
  ThreeGroups groups;
  groups.count[1] = 1;
  groups.std[1] = std::nan("");
  EXPECT_TRUE(std::isnan(stratified_mean(groups, 0.95).interval.low));
  groups.count = {0, 0, 0};
  EXPECT_TRUE(std::isnan(stratified_mean(groups, 0.95).value));
  EXPECT_EQ(stratified_mean(ThreeGroups{{3, 3}, {2.0, 2.0}, {0.0, 0.0}}, 0.95).interval.high, 2.0);
}

}  // namespace
}  // namespace poesy
