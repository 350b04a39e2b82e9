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

TEST(SpreadOfErrors, IsTheToleranceOverTheSigmas) {
  EXPECT_DOUBLE_EQ(sigma_per_tolerance({3.0}), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(mean_square_per_tolerance({3.0}), 1.0 / 9.0);
  EXPECT_DOUBLE_EQ(Spread::of_cpk(1.33).sigmas, 3.99);
}

TEST(SpreadOfErrors, WithAShiftHasWhatTheShiftLeaves) {
  // Cpk = (T - shift T) / (3 sigma), by its definition.
  const Spread spread = Spread::of_cpk(1.5, 0.25);
  const double sigma = sigma_per_tolerance(spread);
  EXPECT_DOUBLE_EQ((1.0 - 0.25) / (3.0 * sigma), 1.5);
  EXPECT_DOUBLE_EQ(mean_square_per_tolerance(spread), sigma * sigma + 0.0625);
}

TEST(PartsOfADrawing, HaveTheEffectsOfTheirErrors) {
  const std::vector<double> effects{1.0, 2.0, 4.0, 0.5, 0.0, 0.25};  // two limits, three errors
  const std::vector<DrawnPart> parts{{{0, 2}, {2.0}}, {{1}, {3.0}}};
  EXPECT_EQ(part_effects(Stacking::root_sum_square, effects, 3, parts),
            (std::vector{5.0 / 4.0, 2.0 * (1.0 / 3.0) * (1.0 / 3.0), 0.75 / 4.0, 0.0}));
  EXPECT_EQ(part_effects(Stacking::worst_case, effects, 3, parts), (std::vector{5.0, 2.0, 0.75, 0.0}));
}

}  // namespace
}  // namespace poesy
