#include "engine/optimise/max_tolerances.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const ToleranceLimits kSquares{Stacking::root_sum_square, 3, {4, 1, 0, 1, 9, 0}, {1.0, 2.0}};
const std::vector<ToleranceRange> kUnbounded(3, {0.0, kInfinity});

MaxTolerances largest(const ToleranceLimits& limits, const std::vector<double>& proportions,
                      const std::vector<ToleranceRange>& ranges) {
  return std::get<MaxTolerances>(maximise_tolerances(limits, proportions, ranges));
}

TEST(MaxTolerances, OfEqualEffectUseEqualSharesOfOneLimit) {
  const ToleranceLimits limits{Stacking::root_sum_square, 4, {4, 1, 9, 0}, {2.0}};
  const std::vector<double> proportions = equal_effect_proportions(limits);
  EXPECT_EQ(proportions[3], kInfinity);
  const MaxTolerances found = largest(limits, proportions, std::vector<ToleranceRange>(4, {0.0, kInfinity}));
  for (const std::size_t i : {0u, 1u, 2u}) {
    EXPECT_NEAR(limits.effects[i] * found.tolerance[i] * found.tolerance[i], 2.0 / 3.0, 1e-13);
  }
  EXPECT_EQ(found.tolerance[3], kInfinity);
}

TEST(MaxTolerances, OfEqualEffectCountTheLimitThatAPartUsesMost) {
  const std::vector<double> squares = equal_effect_proportions(kSquares);
  EXPECT_DOUBLE_EQ(squares[0], 0.5);
  EXPECT_DOUBLE_EQ(squares[1], std::sqrt(2.0) / 3.0);
  ToleranceLimits magnitudes = kSquares;
  magnitudes.stacking = Stacking::worst_case;
  EXPECT_DOUBLE_EQ(equal_effect_proportions(magnitudes)[1], 2.0 / 9.0);
}

TEST(MaxTolerances, OfEqualSizeAreTheClosedForm) {
  const MaxTolerances found = largest(kSquares, {1, 1, 1}, {{0, kInfinity}, {0, kInfinity}, {0, 7}});
  EXPECT_NEAR(found.factor, std::sqrt(1.0 / 5.0), 1e-14);
  EXPECT_EQ(found.limit, 0u);  // limit 1 is reached as well
  EXPECT_EQ(found.tolerance[0], found.factor);
  EXPECT_EQ(found.tolerance[1], found.factor);
  ToleranceLimits magnitudes = kSquares;
  magnitudes.stacking = Stacking::worst_case;
  const MaxTolerances linear = largest(magnitudes, {1, 2, 1}, kUnbounded);
  EXPECT_NEAR(linear.factor, 2.0 / 19.0, 1e-14);
  EXPECT_EQ(linear.limit, 1u);
}

TEST(MaxTolerances, ShareWhatBoundsLeave) {
  // Part 1 stays at its upper bound 0.3, so the first limit gives part 0 the tolerance T with 4 T^2 + 0.3^2 = 1. The
  // second limit allows more.
  const MaxTolerances found = largest(kSquares, {1, 1, 1}, {{0.4, kInfinity}, {0, 0.3}, {0, 1}});
  EXPECT_NEAR(found.tolerance[0], std::sqrt(0.91 / 4.0), 1e-13);
  EXPECT_EQ(found.tolerance[1], 0.3);
  EXPECT_EQ(found.limit, 0u);
}

TEST(MaxTolerances, KeepLowerBoundsAboveTheirProportions) {
  const MaxTolerances found = largest(kSquares, {1, 1, 1}, {{0, kInfinity}, {0.46, 1}, {0, 1}});
  EXPECT_EQ(found.tolerance[1], 0.46);
  EXPECT_NEAR(found.tolerance[0], std::sqrt(2.0 - 9.0 * 0.46 * 0.46), 1e-13);
}

TEST(MaxTolerances, AreAllUpperBoundsWhereNoLimitIsReached) {
  const MaxTolerances found = largest(kSquares, {1, 2, 3}, {{0, 0.1}, {0, 0.2}, {0, 0.3}});
  EXPECT_EQ(found.tolerance, (std::vector{0.1, 0.2, 0.3}));
  EXPECT_EQ(found.factor, kInfinity);
  EXPECT_EQ(found.limit, std::nullopt);
}

TEST(MaxTolerances, CannotMeetWhatLowerBoundsBreak) {
  const auto outcome = maximise_tolerances(kSquares, std::vector{1.0, 1.0, 1.0},
                                           std::vector<ToleranceRange>{{0.6, 1}, {0.5, 1}, {0, 1}});
  const auto broken = std::get<Infeasible>(outcome);
  EXPECT_EQ(broken.limit, 0u);
  EXPECT_DOUBLE_EQ(broken.need, 1.69);
}

TEST(MaxTolerances, NeverBreakALimitByRounding) {
  for (int k = 1; k < 2000; ++k) {
    const ToleranceLimits limits{Stacking::root_sum_square, 3, {1.0 / k, 0.1 * k, 0.37}, {0.01 * k}};
    const MaxTolerances found =
        largest(limits, {0.7, 1.0 / k, 0.3 * k}, {{0, kInfinity}, {0, 0.2}, {0.001, kInfinity}});
    EXPECT_LE(limits.need(0, found.tolerance), limits.room[0]);
    EXPECT_GE(limits.need(0, found.tolerance), limits.room[0] * (1.0 - 1e-13));
  }
}

}  // namespace
}  // namespace poesy
