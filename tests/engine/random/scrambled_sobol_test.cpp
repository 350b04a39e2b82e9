#include "engine/random/scrambled_sobol.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "engine/random/low_discrepancy.h"

namespace poesy {
namespace {

std::vector<double> scrambled(const ScrambledSobol& points, const DesignColumn& column, std::size_t count,
                              std::size_t first = 0) {
  std::vector<double> uniforms(count);
  points.fill(column, SampleIndex(first), uniforms);
  return uniforms;
}

/// [dimensions][count] The first unscrambled Sobol' points, with the origin.
std::vector<std::vector<double>> plain(std::size_t dimensions, std::size_t count) {
  std::vector<double> rows((count - 1) * dimensions);
  SobolSequence(dimensions).next(rows);
  std::vector<std::vector<double>> columns(dimensions, std::vector<double>(count, 0.0));
  for (std::size_t p = 1; p < count; ++p) {
    for (std::size_t d = 0; d < dimensions; ++d) columns[d][p] = rows[(p - 1) * dimensions + d];
  }
  return columns;
}

/// The number of leading binary digits that two numbers in [0, 1) have in common, at most 30.
int common_digits(double x, double y) {
  const auto digits = [](double u) { return static_cast<std::uint32_t>(u * 0x1p30); };
  return std::countl_zero(digits(x) ^ digits(y)) - 2;
}

TEST(ScrambledSobol, KeepsTheDigitsThatAnyTwoPointsShare) {
  // This defines a nested scramble: any two coordinates share as many leading digits as before.
  constexpr std::size_t kPoints = 600;
  const ScrambledSobol points(8, 3);
  const auto before = plain(8, kPoints);
  for (const std::size_t dimension : {0U, 1U, 2U, 7U}) {
    const auto after = scrambled(points, {.dimension = dimension, .replicate = 5}, kPoints);
    for (std::size_t p = 0; p < kPoints; ++p) {
      for (std::size_t q = 0; q < p; ++q) {
        ASSERT_EQ(common_digits(after[p], after[q]), common_digits(before[dimension][p], before[dimension][q]))
            << "points " << p << " and " << q << " of dimension " << dimension;
      }
    }
  }
}

TEST(ScrambledSobol, HasOnePointInEveryStratumOfEachAxis) {
  constexpr std::size_t kDimensions = 600;
  const ScrambledSobol points(kDimensions, 1);
  for (const std::size_t dimension : {0U, 1U, 50U, 299U, 300U, 598U, 599U}) {
    for (const std::size_t count : {1U, 2U, 64U, 4096U}) {
      std::vector<int> seen(count, 0);
      for (const double u : scrambled(points, {.dimension = dimension}, count)) {
        ++seen[static_cast<std::size_t>(u * static_cast<double>(count))];
      }
      EXPECT_TRUE(std::ranges::all_of(seen, [](int n) { return n == 1; })) << dimension << ", " << count;
    }
  }
}

/// The numbers of points in 2^split x 2^(bits - split) equal boxes of the unit square.
std::vector<int> box_counts(const std::vector<double>& x, const std::vector<double>& y, int split, int bits) {
  std::vector<int> counts(std::size_t{1} << bits, 0);
  for (std::size_t p = 0; p < x.size(); ++p) {
    const auto column = static_cast<std::size_t>(x[p] * std::ldexp(1.0, split));
    const auto row = static_cast<std::size_t>(y[p] * std::ldexp(1.0, bits - split));
    ++counts[column << (bits - split) | row];
  }
  std::ranges::sort(counts);
  return counts;
}

TEST(ScrambledSobol, BalancesElementaryIntervalsAsBefore) {
  constexpr int kBits = 10;
  constexpr std::size_t kPoints = std::size_t{1} << kBits;
  constexpr std::size_t kDimensions = 6;
  const ScrambledSobol points(kDimensions, 9);
  const auto before = plain(kDimensions, kPoints);
  for (std::size_t i = 0; i < kDimensions; ++i) {
    for (std::size_t j = i + 1; j < kDimensions; ++j) {
      const auto x = scrambled(points, {.dimension = i}, kPoints);
      const auto y = scrambled(points, {.dimension = j}, kPoints);
      for (int split = 0; split <= kBits; ++split) {
        EXPECT_EQ(box_counts(x, y, split, kBits), box_counts(before[i], before[j], split, kBits))
            << i << ", " << j << ", " << split;
      }
    }
  }
}

TEST(ScrambledSobol, IsTheSameInAnyPortions) {
  const ScrambledSobol points(3, 4);
  const DesignColumn column{.dimension = 2, .replicate = 1};
  const auto whole = scrambled(points, column, 1000);
  std::vector<double> portions;
  for (std::size_t first = 0, count = 1; first < 1000; first += count, count = count * 3 / 2 + 1) {
    const auto more = scrambled(points, column, std::min(count, 1000 - first), first);
    portions.insert(portions.end(), more.begin(), more.end());
  }
  EXPECT_EQ(portions, whole);
}

TEST(ScrambledSobol, ReachesItsLastPoint) {
  const ScrambledSobol points(2, 4);
  const std::size_t first = ScrambledSobol::kMostPoints - 3;
  const auto last = scrambled(points, {.dimension = 1}, 3, first);
  EXPECT_EQ(scrambled(points, {.dimension = 1}, 1, first + 2)[0], last[2]);
  EXPECT_NE(last[0], last[2]);
}

TEST(ScrambledSobol, DimensionsReplicatesAndSeedsDiffer) {
  const ScrambledSobol points(3, 4);
  const auto some = scrambled(points, {.dimension = 1, .replicate = 1}, 4);
  EXPECT_NE(scrambled(points, {.dimension = 2, .replicate = 1}, 4), some);
  EXPECT_NE(scrambled(points, {.dimension = 1, .replicate = 2}, 4), some);
  EXPECT_NE(scrambled(ScrambledSobol(3, 5), {.dimension = 1, .replicate = 1}, 4), some);
  EXPECT_EQ(scrambled(ScrambledSobol(30, 4), {.dimension = 1, .replicate = 1}, 4), some);
}

TEST(ScrambledSobol, StaysStrictlyInside) {
  const ScrambledSobol points(2, 8);
  for (const double u : scrambled(points, {.dimension = 1}, 100000)) {
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
  }
}

TEST(ScrambledSobol, RejectsMoreDimensionsThanTabulated) {
  EXPECT_NO_THROW(ScrambledSobol(3667, 1));
  EXPECT_THROW(ScrambledSobol(3668, 1), std::invalid_argument);
}

}  // namespace
}  // namespace poesy
