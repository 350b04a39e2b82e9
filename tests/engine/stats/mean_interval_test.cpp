#include "engine/stats/mean_interval.h"

#include <gtest/gtest.h>

#include <cmath>

namespace poesy {
namespace {

Moments of(const std::vector<double>& values) { return Moments::of(values); }

TEST(MeanInterval, IsStudents) {
  // Tables of Student's t: 2.776445 for 4 degrees of freedom and 12.706205 for one, at 95 %; 4.604095 for 4 at 99 %.
  const Moments five = of({1.0, 2.0, 3.0, 4.0, 5.0});
  const double error = std::sqrt(2.5 / 5.0);
  const Interval usual = mean_interval(five, 0.95);
  EXPECT_NEAR(usual.low, 3.0 - 2.776445 * error, 1e-6);
  EXPECT_NEAR(usual.high, 3.0 + 2.776445 * error, 1e-6);
  EXPECT_NEAR(mean_interval(five, 0.99).high, 3.0 + 4.604095 * error, 1e-6);
  EXPECT_NEAR(mean_interval(of({-1.0, 1.0}), 0.95).high, 12.706205, 1e-5);
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

}  // namespace
}  // namespace poesy
