#include "engine/stats/indices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace poesy {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSolver = 1e-15;  ///< rounding of the response (m), see Model::rounding

TEST(IndexRounding, IsThatOfSolvesOverTheErrorOrOfDigits) {
  EXPECT_DOUBLE_EQ(index_rounding(kSolver, 1e-7), 1e-8);
  EXPECT_EQ(index_rounding(kSolver, 1e-3), kIndexRounding);
  EXPECT_EQ(index_rounding(0.0, 1e-300), kIndexRounding);
}

TEST(HasEffect, ComparesTheEffectWithTheRoundingOfSolves) {
  for (const double sigma : {1e-3, 1e-6, 1e-9}) {
    const double rounding = index_rounding(kSolver, sigma);
    EXPECT_TRUE(has_effect(1.01 * rounding, rounding)) << sigma;
    EXPECT_FALSE(has_effect(0.99 * rounding, rounding)) << sigma;
    EXPECT_FALSE(has_effect(kNaN, rounding)) << sigma;
  }
}

TEST(ToldFromRounding, IsTheIndexOrNothingOrUnknown) {
  const double large = index_rounding(kSolver, 1e-7);
  EXPECT_EQ(told_from_rounding(0.5, large), 0.5);
  EXPECT_EQ(told_from_rounding(5e-9, large), 0.0);
  EXPECT_TRUE(std::isnan(told_from_rounding(kNaN, large)));
  const double small = index_rounding(kSolver, 1e-12);  // the rounding threshold of the index is 1e-3
  EXPECT_EQ(told_from_rounding(0.5, small), 0.5);
  EXPECT_TRUE(std::isnan(told_from_rounding(5e-4, small)));
  EXPECT_TRUE(std::isnan(told_from_rounding(0.0, small)));
}

TEST(IsTooSmallToTell, WhereAnIndexOfInterestWouldBeRounding) {
  EXPECT_FALSE(is_too_small_to_tell(0.0, index_rounding(kSolver, 1.01e-9)));
  EXPECT_TRUE(is_too_small_to_tell(0.0, index_rounding(kSolver, 0.99e-9)));
  EXPECT_FALSE(is_too_small_to_tell(0.5, index_rounding(kSolver, 0.99e-9)));
}

TEST(SizeRounding, IsThatOfSolvesOrOfDigits) {
  EXPECT_EQ(size_rounding(kSolver, 1e-3, 1e-2), 1e-12);
  EXPECT_EQ(size_rounding(kSolver, 1e-6, kNaN), kSolver);
  EXPECT_EQ(size_rounding(0.0, kNaN, 1e-3), 1e-13);
}

/// Effects of errors that vary together add up as root sum square. If each effect alone is below its rounding
/// threshold, the effect of all is below the joint one.
TEST(JointRounding, IsAboveWhatErrorsWithoutEffectDoTogether) {
  const std::vector<double> sigma{1e-3, 2e-3, 1e-9};
  const double rounding = joint_rounding(kSolver, sigma);
  EXPECT_DOUBLE_EQ(rounding, std::sqrt(1e-26 + 4e-26 + 1e-30));
  double squares = 0.0;
  for (const double one : sigma) squares += std::pow(0.999 * index_rounding(kSolver, one) * one, 2);
  EXPECT_FALSE(has_effect(std::sqrt(squares), rounding));
  EXPECT_TRUE(has_effect(1e-6 * sigma[0], rounding));
}

TEST(IsConstant, AsksOfAllPosesWhatIsKnown) {
  EXPECT_TRUE(is_constant(std::vector{0.0, 1e-20, 9e-13}, 1e-12));
  EXPECT_FALSE(is_constant(std::vector{0.0, 1.1e-12}, 1e-12));
  EXPECT_TRUE(is_constant(std::vector{kNaN, 0.0}, 1e-12));
  EXPECT_FALSE(is_constant(std::vector{kNaN, kNaN}, 1e-12)) << "nothing is known";
}

}  // namespace
}  // namespace poesy
