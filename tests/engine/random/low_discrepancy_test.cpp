#include "engine/random/low_discrepancy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <vector>

namespace poesy {
namespace {

/// [count x dimensions] The first Sobol' points after the origin.
std::vector<double> sobol_points(std::size_t count, std::size_t dimensions) {
  std::vector<double> points(count * dimensions);
  SobolSequence(dimensions).next(points);
  return points;
}

TEST(SobolPoints, MatchesThePublishedPoints) {
  // Joe and Kuo's example for new-joe-kuo-6.21201, dimensions 1 to 3, without the origin.
  const std::vector<double> published{0.5,   0.5,   0.5,    //
                                      0.75,  0.25,  0.25,   //
                                      0.25,  0.75,  0.75,   //
                                      0.375, 0.375, 0.625,  //
                                      0.875, 0.875, 0.125,  //
                                      0.625, 0.125, 0.875,  //
                                      0.125, 0.625, 0.375};
  EXPECT_EQ(sobol_points(7, 3), published);
}

TEST(SobolPoints, FewerPointsAreThePrefixOfMore) {
  const std::vector<double> more = sobol_points(300, 3);
  for (const std::size_t count : {std::size_t{1}, std::size_t{20}, std::size_t{158}}) {
    const std::vector<double> fewer = sobol_points(count, 3);
    ASSERT_EQ(fewer.size(), 3 * count);
    EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), more.begin())) << count;
  }
}

TEST(SobolSequence, GivesTheSamePointsInAnyPortions) {
  SobolSequence sequence(3);
  std::vector<double> points(3 * 300);
  const std::span<double> all(points);
  sequence.next(all.first(3));
  sequence.next(all.subspan(3, 3 * 20));
  for (std::size_t point = 21; point < 300; ++point) sequence.next(all.subspan(3 * point, 3));
  EXPECT_EQ(points, sobol_points(300, 3));
}

TEST(SobolPoints, StaysStrictlyInside) {
  for (const double coordinate : sobol_points(5000, 25)) {
    ASSERT_GT(coordinate, 0.0);
    ASSERT_LT(coordinate, 1.0);
  }
}

TEST(SobolPoints, FillsEveryCellOfEachAxisOnce) {
  // The first 2^m points, with the origin, have exactly one point in each of 2^m equal cells of every axis.
  constexpr std::size_t kCells = 256;
  constexpr std::size_t kDimensions = 6;
  const std::vector<double> points = sobol_points(kCells - 1, kDimensions);
  for (std::size_t axis = 0; axis < kDimensions; ++axis) {
    std::vector<int> seen(kCells, 0);
    seen[0] = 1;
    for (std::size_t p = 0; p < kCells - 1; ++p) {
      ++seen[static_cast<std::size_t>(points[p * kDimensions + axis] * kCells)];
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; })) << "axis " << axis;
  }
}

TEST(SobolPoints, RejectsMoreDimensionsThanTabulated) {
  EXPECT_NO_THROW(sobol_points(1, 3667));
  EXPECT_THROW(sobol_points(1, 3668), std::invalid_argument);
}

}  // namespace
}  // namespace poesy
