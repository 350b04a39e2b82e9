#include "engine/kinds/sensitivity/fidelity.h"
#include "engine/kinds/sensitivity/result.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace poesy::sensitivity {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSigma = 1e-3;

/// Two lengths and an angle, one error, two poses: indices and means that are easy to follow.
Result result_of(const std::vector<double>& indices) {
  const std::size_t responses = indices.size();
  Result result;
  result.global = {{responses, 1}, indices};
  result.count = Result::Cells<std::uint64_t>({responses, 1, 2}, 100);
  result.mean = result.std = Result::Cells<double>({responses, 1, 2});
  result.local = result.std;
  for (std::size_t r = 0; r < responses; ++r) std::ranges::fill(result.std.row(r), indices[r] * kSigma);
  result.background = Array<double, axis::Response, axis::Pose>({responses, 2});
  result.solves = Array<SolveCounts, axis::Factor, axis::Pose>({1, 2});
  return result;
}

FidelityResult compare(const Result& first, const Result& second, double sigma = kSigma) {
  constexpr std::array kDimensions{Dimension::length, Dimension::length, Dimension::angle};
  return compare_fidelities(first, second, std::span(kDimensions).first(first.responses()), std::span(&sigma, 1), 0.01);
}

TEST(CompareFidelities, EqualResultsAreLinear) {
  const FidelityResult found = compare(result_of({2.0, 0.5, 3.0}), result_of({2.0, 0.5, 3.0}));
  const FidelityResult::Indices none({3, 1});
  EXPECT_EQ(found.discrepancy, none);
  EXPECT_EQ(found.relative_discrepancy, none);
  EXPECT_EQ(found.nonlinearity, none);
  EXPECT_EQ(found.linear(0), 1);
}

TEST(CompareFidelities, RatiosAreOfTheLargestIndexOfTheDimension) {
  const FidelityResult found = compare(result_of({2.0, 0.5, 4.0}), result_of({2.0, 0.25, 3.0}));
  EXPECT_EQ(found.global, FidelityResult::Indices({3, 1}, {2.0, 0.25, 3.0}));
  EXPECT_EQ(found.discrepancy, FidelityResult::Indices({3, 1}, {0.0, -0.25, -1.0}));
  EXPECT_EQ(found.relative_discrepancy, FidelityResult::Indices({3, 1}, {0.0, -0.125, -0.25}));
  EXPECT_NEAR(found.nonlinearity(1, 0), 0.125, 1e-15);
  EXPECT_NEAR(found.nonlinearity(2, 0), 0.25, 1e-15);
  EXPECT_EQ(found.linear(0), 0);
}

TEST(CompareFidelities, SmallDifferenceInASmallComponentIsLinear) {
  const FidelityResult found = compare(result_of({2.0, 0.02, 1.0}), result_of({2.0, 0.005, 1.0}));
  EXPECT_NEAR(found.relative_discrepancy(1, 0), -0.0075, 1e-15);
  EXPECT_EQ(found.linear(0), 1);
}

TEST(CompareFidelities, SeesAShiftOfTheMeanOverTheBackground) {
  Result first = result_of({2.0});
  first.mean = {{1, 1, 2}, {3e-4 + 0.04 * kSigma, 5e-4 - 0.08 * kSigma}};
  first.background = {{1, 2}, {3e-4, 5e-4}};
  const FidelityResult found = compare(first, result_of({2.0}));
  EXPECT_EQ(found.relative_discrepancy(0, 0), 0.0);
  EXPECT_NEAR(found.nonlinearity(0, 0), std::sqrt((0.04 * 0.04 + 0.08 * 0.08) / 2.0) / 2.0, 1e-12);
  EXPECT_EQ(found.linear(0), 0);
}

TEST(CompareFidelities, NoEffectAtEitherIsLinearWithoutRatios) {
  const FidelityResult found = compare(result_of({1e-13, 0.0, 2.0}), result_of({0.0, 0.0, 2.0}));
  EXPECT_TRUE(std::isnan(found.relative_discrepancy(0, 0)) && std::isnan(found.nonlinearity(0, 0)));
  EXPECT_EQ(found.relative_discrepancy(2, 0), 0.0);
  EXPECT_EQ(found.linear(0), 1);
}

TEST(CompareFidelities, RoundingOfSmallErrorsIsNoEffect) {
  constexpr double kSmall = 1e-6;  // with this sigma, rounding of 1e-15 gives an index of 1e-9
  EXPECT_EQ(compare(result_of({1e-9, 0.0, 2.0}), result_of({0.0, 0.0, 2.0}), kSmall).linear(0), 1);
  EXPECT_EQ(compare(result_of({1e-9, 0.0, 2.0}), result_of({0.0, 0.0, 2.0})).linear(0), 0);
}

TEST(CompareFidelities, EffectAtOneOfThemOnlyIsNotLinear) {
  const FidelityResult only_second = compare(result_of({0.0, 0.0, 2.0}), result_of({1e-3, 0.0, 2.0}));
  EXPECT_TRUE(std::isinf(only_second.relative_discrepancy(0, 0)));
  EXPECT_EQ(only_second.linear(0), 0);
  const FidelityResult only_first = compare(result_of({1e-3, 0.0, 2.0}), result_of({0.0, 0.0, 2.0}));
  EXPECT_EQ(only_first.relative_discrepancy(0, 0), -1.0);
  EXPECT_EQ(only_first.linear(0), 0);
}

TEST(CompareFidelities, WhatIsNotKnownIsNotLinear) {
  EXPECT_EQ(compare(result_of({2.0, kNaN, 1.0}), result_of({2.0, 1.0, 1.0})).linear(0), 0);
  EXPECT_EQ(compare(result_of({2.0, 1.0, 1.0}), result_of({2.0, kNaN, 1.0})).linear(0), 0);
  Result without_background = result_of({2.0});
  without_background.background(0, 1) = kNaN;
  EXPECT_EQ(compare(without_background, result_of({2.0})).linear(0), 0);
}

TEST(CompareFidelities, OtherSamplesAreNoComparison) {
  Result second = result_of({2.0, 1.0, 1.0});
  second.count(2, 0, 0) = 99;
  second.solves(0, 1).by_status[static_cast<std::size_t>(SolveStatus::singular)] = 1;
  const FidelityResult found = compare(result_of({2.0, 1.0, 1.0}), second);
  EXPECT_EQ(found.linear(0), 0);
  EXPECT_EQ(found.not_converged(0, 0), 0U);
  EXPECT_EQ(found.not_converged(0, 1), 1U);
}

}  // namespace
}  // namespace poesy::sensitivity
