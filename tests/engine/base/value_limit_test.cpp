#include "engine/base/value_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double deciding(const ValueLimit& limit, std::vector<double> values, std::size_t poses) {
  return limit.deciding(values, poses);
}

bool keeps(const ValueLimit& limit, std::vector<double> values, std::size_t poses) {
  return limit.keeps(values, poses);
}

TEST(ValueLimit, OfANumberIsOnTheMagnitude) {
  const ValueLimit limit = 0.5;
  EXPECT_TRUE(limit.is_plain());
  EXPECT_EQ(limit.from(), -0.5);
  EXPECT_TRUE(limit.holds(0.5) && limit.holds(-0.5));
  EXPECT_FALSE(limit.holds(std::nextafter(0.5, 1.0)) || limit.holds(-0.6) || limit.holds(kNone));
  EXPECT_EQ(limit.badness(-0.6), 0.6);
  EXPECT_EQ(ValueLimit::between(-0.5, 0.5), limit);
  EXPECT_TRUE(ValueLimit().holds(kInfinity));
}

TEST(ValueLimit, OfTwoEndsIsOnTheValue) {
  const ValueLimit limit = ValueLimit::between(-0.02, 0.1);
  EXPECT_FALSE(limit.is_magnitude() || limit.is_over_poses());
  EXPECT_TRUE(limit.holds(-0.02) && limit.holds(0.1) && limit.holds(0.0));
  EXPECT_FALSE(limit.holds(-0.03) || limit.holds(0.11));
  EXPECT_LT(limit.badness(0.0), 0.0);
  EXPECT_DOUBLE_EQ(limit.badness(-0.05), 0.03);
  EXPECT_DOUBLE_EQ(limit.badness(0.15), 0.05);
  EXPECT_EQ(limit.badness(kNone), kInfinity);
  EXPECT_TRUE(ValueLimit::between(-kInfinity, 0.1).holds(-1e9));
  EXPECT_TRUE(ValueLimit::between(-0.1, kInfinity).holds(1e9));
}

TEST(ValueLimit, AtAShareOfThePosesForgivesTheOthers) {
  const ValueLimit limit = ValueLimit::between(-1.0, 2.0).at_share(0.9);
  EXPECT_TRUE(limit.is_over_poses());
  EXPECT_EQ(limit.poses_beyond(9), 0u);
  EXPECT_EQ(limit.poses_beyond(10), 1u);
  EXPECT_EQ(limit.poses_beyond(29), 2u);
  EXPECT_EQ(ValueLimit(1.0).at_share(0.99).poses_beyond(100), 1u);
  const std::vector<double> values{0.0, 3.0, 1.0, -1.5, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(deciding(limit, values, 10), -1.5);
  EXPECT_FALSE(keeps(limit, values, 10));
  EXPECT_TRUE(keeps(limit, {0.0, 3.0, 1.0, -1.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0}, 10));
  EXPECT_TRUE(keeps(limit, {5.0}, 10));
  EXPECT_FALSE(keeps(limit, {5.0, 5.0}, 10));
  EXPECT_EQ(limit.at_share(1.0), ValueLimit::between(-1.0, 2.0));
}

TEST(ValueLimit, OfTheSpreadComparesTheEndsOfTheValues) {
  const ValueLimit limit = ValueLimit::of_spread(0.5);
  EXPECT_TRUE(limit.is_over_poses());
  EXPECT_EQ(deciding(limit, {7.0, 7.25, 6.75}, 3), 0.5);
  EXPECT_TRUE(keeps(limit, {7.0, 7.25, 6.75}, 3));
  EXPECT_FALSE(keeps(limit, {7.0, 7.25, 6.5}, 3));
  EXPECT_TRUE(keeps(limit, {}, 3));
  EXPECT_FALSE(keeps(limit, {7.0, kNone}, 2));
}

}  // namespace
}  // namespace poesy
