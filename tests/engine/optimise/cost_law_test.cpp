#include "engine/optimise/cost_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace poesy {
namespace {

const std::vector<CostLaw> kLaws{CostLaw::reciprocal(3.0, 0.5), CostLaw::reciprocal_power(1.0, 0.02, 2.0),
                                 CostLaw::reciprocal_power(0.0, 0.1, 0.7), CostLaw::exponential(2.0, 9.0, 0.04)};
constexpr Stacking kStackings[]{Stacking::root_sum_square, Stacking::worst_case};

TEST(CostLaws, AreWhatTheirNamesSay) {
  EXPECT_EQ(CostLaw::constant(7.0).at(0.1), 7.0);
  EXPECT_DOUBLE_EQ(CostLaw::reciprocal(3.0, 0.5).at(0.1), 8.0);
  EXPECT_DOUBLE_EQ(CostLaw::reciprocal_power(1.0, 0.02, 2.0).at(0.1), 3.0);
  EXPECT_DOUBLE_EQ(CostLaw::reciprocal_power(1.0, 0.02, 1.5).at(0.25), 1.16);
  EXPECT_DOUBLE_EQ(CostLaw::exponential(2.0, 9.0, 0.05).at(0.1), 2.0 + 9.0 * std::exp(-2.0));
  EXPECT_EQ(CostLaw::reciprocal(3.0, 0.5).at(0.0), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(CostLaw::reciprocal(3.0, 0.0).is_constant());
  EXPECT_FALSE(CostLaw::exponential(0.0, 1.0, 1.0).is_constant());
}

TEST(CostLaws, HaveTheDerivativesOfTheirValues) {
  for (const CostLaw& law : kLaws) {
    for (const Stacking stacking : kStackings) {
      for (const double tolerance : {0.01, 0.1, 0.3}) {
        const double size = size_of(tolerance, stacking);
        const double h = 1e-4 * size;
        const CostCurve here = law.curve(size, stacking);
        const CostCurve above = law.curve(size + h, stacking);
        const CostCurve below = law.curve(size - h, stacking);
        EXPECT_DOUBLE_EQ(here.value, law.at(tolerance));
        EXPECT_NEAR(here.slope, (above.value - below.value) / (2.0 * h), 1e-6 * std::abs(here.slope));
        EXPECT_NEAR(here.curvature, (above.slope - below.slope) / (2.0 * h), 1e-6 * here.curvature);
        EXPECT_LT(here.slope, 0.0);
        EXPECT_GT(here.curvature, 0.0);
      }
    }
  }
}

TEST(CostLaws, ThatAreConstantHaveNoSlope) {
  const CostCurve curve = CostLaw::constant(7.0).curve(0.1, Stacking::root_sum_square);
  EXPECT_EQ(curve.value, 7.0);
  EXPECT_EQ(curve.slope, 0.0);
  EXPECT_EQ(curve.curvature, 0.0);
}

TEST(CostLaws, AreCheapestWhereTheSlopePaysThePrice) {
  for (const CostLaw& law : kLaws) {
    for (const Stacking stacking : kStackings) {
      for (const double price : {1e-3, 0.5, 10.0, 100.0}) {
        const double size = law.cheapest_size(price, stacking);
        ASSERT_GT(size, 0.0);
        EXPECT_NEAR(-law.curve(size, stacking).slope, price, 1e-11 * price);
      }
      EXPECT_EQ(law.cheapest_size(0.0, stacking), std::numeric_limits<double>::infinity());
    }
  }
}

TEST(CostLaws, OfBoundedSlopeAreCheapestAtZeroAboveThatPrice) {
  EXPECT_EQ(CostLaw::exponential(2.0, 9.0, 0.04).cheapest_size(226.0, Stacking::worst_case), 0.0);
}

TEST(CostLaws, TakePricesOfAnySize) {
  for (const CostLaw& law : kLaws) {
    for (const Stacking stacking : kStackings) {
      for (const double price : {1e-250, 1e-100, 1e100, 1e250}) {
        EXPECT_TRUE(std::isfinite(law.cheapest_size(price, stacking)));
        EXPECT_GE(law.cheapest_size(price, stacking), 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace poesy
