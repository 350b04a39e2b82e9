#include "engine/random/latin_hypercube.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace poesy {
namespace {

std::vector<double> column_of(const LatinHypercube& design, const DesignColumn& column, std::size_t count,
                              std::size_t first = 0) {
  std::vector<double> uniforms(count);
  design.fill(column, SampleIndex(first), uniforms);
  return uniforms;
}

TEST(LatinHypercube, HasOneSampleInEveryStratum) {
  for (const std::size_t n : {1U, 2U, 3U, 4U, 5U, 7U, 8U, 9U, 100U, 1000U, 4096U, 4097U, 100003U}) {
    for (const std::size_t dimension : {0U, 1U, 599U}) {
      std::vector<int> seen(n, 0);
      for (const double u : column_of(LatinHypercube(n, 3), {.dimension = dimension, .replicate = 2}, n)) {
        ASSERT_GT(u, 0.0);
        ASSERT_LT(u, 1.0);
        ++seen[static_cast<std::size_t>(u * static_cast<double>(n))];
      }
      EXPECT_TRUE(std::ranges::all_of(seen, [](int count) { return count == 1; })) << n << ", " << dimension;
    }
  }
}

TEST(LatinHypercube, IsTheSameInAnyPortions) {
  const LatinHypercube design(1000, 4);
  const DesignColumn column{.dimension = 2, .replicate = 1};
  const auto whole = column_of(design, column, 1000);
  std::vector<double> portions;
  for (std::size_t first = 0, count = 1; first < 1000; first += count, count = count * 3 / 2 + 1) {
    const auto more = column_of(design, column, std::min(count, 1000 - first), first);
    portions.insert(portions.end(), more.begin(), more.end());
  }
  EXPECT_EQ(portions, whole);
}

TEST(LatinHypercube, DimensionsReplicatesAndSeedsDiffer) {
  const LatinHypercube design(100, 4);
  const auto some = column_of(design, {.dimension = 1, .replicate = 1}, 100);
  EXPECT_NE(column_of(design, {.dimension = 2, .replicate = 1}, 100), some);
  EXPECT_NE(column_of(design, {.dimension = 1, .replicate = 2}, 100), some);
  EXPECT_NE(column_of(LatinHypercube(100, 5), {.dimension = 1, .replicate = 1}, 100), some);
}

TEST(LatinHypercube, ReachesItsLastSample) {
  const LatinHypercube design(LatinHypercube::kMostSamples, 4);
  for (const double u : column_of(design, {}, 1000, LatinHypercube::kMostSamples - 1000)) {
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
  }
}

}  // namespace
}  // namespace poesy
