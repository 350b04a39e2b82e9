#include "engine/optimise/tolerance_limits.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace poesy {
namespace {

TEST(LimitsOnTolerances, AddSquaresOrMagnitudes) {
  ToleranceLimits limits{Stacking::root_sum_square, 2, {4.0, 9.0, 1.0, 0.0}, {5.0, 0.5}};
  const std::vector<double> tolerance{0.5, 1.0 / 3.0};
  EXPECT_DOUBLE_EQ(limits.need(0, tolerance), 2.0);
  limits.stacking = Stacking::worst_case;
  EXPECT_DOUBLE_EQ(limits.need(0, tolerance), 5.0);
  EXPECT_EQ(limits.need(1, tolerance), 0.5);
}

TEST(LimitsOnTolerances, AreUsedMostWhereTheShareIsLargest) {
  const ToleranceLimits limits{Stacking::worst_case, 2, {4.0, 9.0, 1.0, 0.0, 1.0, 0.0}, {10.0, 0.5, 0.5}};
  const LimitUse use = worst_use(limits, std::vector{0.5, 1.0 / 3.0});
  EXPECT_EQ(use.limit, 1u);
  EXPECT_EQ(use.share, 1.0);
}

TEST(LimitsOnTolerances, WithoutRoomAreBroken) {
  const ToleranceLimits limits{Stacking::worst_case, 1, {1.0, 1.0}, {10.0, -1e-9}};
  const LimitUse use = worst_use(limits, std::vector{0.0});
  EXPECT_EQ(use.limit, 1u);
  EXPECT_EQ(use.share, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace poesy
