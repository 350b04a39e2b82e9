#include "engine/kinds/sensitivity/fidelity.h"
#include "engine/kinds/sensitivity/result.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace poesy {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSigma = 1e-3;

/// Two lengths and an angle, one error, two poses: indices and means that are easy to follow.
SensitivityResult result_of(const std::vector<double>& indices) {
  SensitivityResult result;
  result.responses = indices.size();
  result.factors = 1;
  result.poses = 2;
  result.global = indices;
  for (const double index : indices) {
    for (std::size_t m = 0; m < 2; ++m) {
      result.count.push_back(100.0);
      result.mean.push_back(0.0);
      result.std.push_back(index * kSigma);
      result.background.push_back(0.0);
    }
  }
  result.solves.resize(2);
  return result;
}

FidelityResult compare(const SensitivityResult& first, const SensitivityResult& second, double sigma = kSigma) {
  constexpr std::array kDimensions{Dimension::length, Dimension::length, Dimension::angle};
  return compare_fidelities(first, second, std::span(kDimensions).first(first.responses), std::span(&sigma, 1), 0.01);
}

TEST(CompareFidelities, EqualResultsAreLinear) {
  const FidelityResult found = compare(result_of({2.0, 0.5, 3.0}), result_of({2.0, 0.5, 3.0}));
  EXPECT_EQ(found.discrepancy, std::vector<double>(3, 0.0));
  EXPECT_EQ(found.relative_discrepancy, std::vector<double>(3, 0.0));
  EXPECT_EQ(found.nonlinearity, std::vector<double>(3, 0.0));
  EXPECT_EQ(found.linear, std::vector<std::uint8_t>{1});
}

TEST(CompareFidelities, RatiosAreOfTheLargestIndexOfTheDimension) {
  const FidelityResult found = compare(result_of({2.0, 0.5, 4.0}), result_of({2.0, 0.25, 3.0}));
  EXPECT_EQ(found.global, (std::vector<double>{2.0, 0.25, 3.0}));
  EXPECT_EQ(found.discrepancy, (std::vector<double>{0.0, -0.25, -1.0}));
  EXPECT_EQ(found.relative_discrepancy, (std::vector<double>{0.0, -0.125, -0.25}));
  EXPECT_NEAR(found.nonlinearity[1], 0.125, 1e-15);
  EXPECT_NEAR(found.nonlinearity[2], 0.25, 1e-15);
  EXPECT_EQ(found.linear, std::vector<std::uint8_t>{0});
}

TEST(CompareFidelities, SmallDifferenceInASmallComponentIsLinear) {
  const FidelityResult found = compare(result_of({2.0, 0.02, 1.0}), result_of({2.0, 0.005, 1.0}));
  EXPECT_NEAR(found.relative_discrepancy[1], -0.0075, 1e-15);
  EXPECT_EQ(found.linear, std::vector<std::uint8_t>{1});
}

TEST(CompareFidelities, SeesAShiftOfTheMeanOverTheBackground) {
  SensitivityResult first = result_of({2.0});
  first.mean = {3e-4 + 0.04 * kSigma, 5e-4 - 0.08 * kSigma};
  first.background = {3e-4, 5e-4};
  const FidelityResult found = compare(first, result_of({2.0}));
  EXPECT_EQ(found.relative_discrepancy[0], 0.0);
  EXPECT_NEAR(found.nonlinearity[0], std::sqrt((0.04 * 0.04 + 0.08 * 0.08) / 2.0) / 2.0, 1e-12);
  EXPECT_EQ(found.linear, std::vector<std::uint8_t>{0});
}

TEST(CompareFidelities, NoEffectAtEitherIsLinearWithoutRatios) {
  const FidelityResult found = compare(result_of({1e-13, 0.0, 2.0}), result_of({0.0, 0.0, 2.0}));
  EXPECT_TRUE(std::isnan(found.relative_discrepancy[0]) && std::isnan(found.nonlinearity[0]));
  EXPECT_EQ(found.relative_discrepancy[2], 0.0);
  EXPECT_EQ(found.linear, std::vector<std::uint8_t>{1});
}

TEST(CompareFidelities, RoundingOfSmallErrorsIsNoEffect) {
  constexpr double kSmall = 1e-6;  // a spread of 1e-15 is an index of 1e-9
  EXPECT_EQ(compare(result_of({1e-9, 0.0, 2.0}), result_of({0.0, 0.0, 2.0}), kSmall).linear[0], 1);
  EXPECT_EQ(compare(result_of({1e-9, 0.0, 2.0}), result_of({0.0, 0.0, 2.0})).linear[0], 0);
}

TEST(CompareFidelities, EffectAtOneOfThemOnlyIsNotLinear) {
  const FidelityResult only_second = compare(result_of({0.0, 0.0, 2.0}), result_of({1e-3, 0.0, 2.0}));
  EXPECT_TRUE(std::isinf(only_second.relative_discrepancy[0]));
  EXPECT_EQ(only_second.linear, std::vector<std::uint8_t>{0});
  const FidelityResult only_first = compare(result_of({1e-3, 0.0, 2.0}), result_of({0.0, 0.0, 2.0}));
  EXPECT_EQ(only_first.relative_discrepancy[0], -1.0);
  EXPECT_EQ(only_first.linear, std::vector<std::uint8_t>{0});
}

TEST(CompareFidelities, WhatIsNotKnownIsNotLinear) {
  EXPECT_EQ(compare(result_of({2.0, kNaN, 1.0}), result_of({2.0, 1.0, 1.0})).linear[0], 0);
  EXPECT_EQ(compare(result_of({2.0, 1.0, 1.0}), result_of({2.0, kNaN, 1.0})).linear[0], 0);
  SensitivityResult without_background = result_of({2.0});
  without_background.background[1] = kNaN;
  EXPECT_EQ(compare(without_background, result_of({2.0})).linear[0], 0);
}

TEST(CompareFidelities, OtherSamplesAreNoComparison) {
  SensitivityResult second = result_of({2.0, 1.0, 1.0});
  second.count[4] = 99.0;
  second.solves[1].by_status[static_cast<std::size_t>(SolveStatus::singular)] = 1;
  const FidelityResult found = compare(result_of({2.0, 1.0, 1.0}), second);
  EXPECT_EQ(found.linear, std::vector<std::uint8_t>{0});
  EXPECT_EQ(found.not_converged, (std::vector<std::uint64_t>{0, 1}));
}

}  // namespace
}  // namespace poesy
