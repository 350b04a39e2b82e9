#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "engine/stats/moments.h"

namespace poesy {
namespace {

Moments moments_of(std::span<const double> values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

/// Skewed numbers with an offset, so that every term of the update formulas matters.
std::vector<double> skewed_values(std::size_t count) {
  std::mt19937_64 engine(3);
  std::lognormal_distribution<double> draw;
  std::vector<double> values(count);
  for (double& value : values) value = draw(engine) - 4.0;
  return values;
}

void expect_same(const Moments& a, const Moments& b, double tolerance) {
  EXPECT_EQ(a.count(), b.count());
  EXPECT_NEAR(a.mean(), b.mean(), tolerance * b.standard_deviation());
  EXPECT_NEAR(a.variance(), b.variance(), tolerance * b.variance());
  EXPECT_NEAR(a.kurtosis(), b.kurtosis(), tolerance * b.kurtosis());
}

void expect_same_bits(const Moments& a, const Moments& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  EXPECT_EQ(a.count(), b.count());
  EXPECT_EQ(bits(a.mean()), bits(b.mean()));
  EXPECT_EQ(bits(a.variance()), bits(b.variance()));
  EXPECT_EQ(bits(a.kurtosis()), bits(b.kurtosis()));
}

TEST(MomentsOf, ABlockIsItsNumbersOneByOne) {
  std::vector<double> values = skewed_values(1003);
  for (const std::size_t count : {1u, 2u, 7u, 8u, 9u, 64u, 1003u}) {
    const auto block = std::span<const double>(values).first(count);
    const Moments whole = Moments::of(block);
    EXPECT_EQ(whole.count(), count);
    if (count == 1) continue;
    expect_same(whole, moments_of(block), 1e-12);
  }
  for (double& value : values) value += 1e6;
  expect_same(Moments::of(values), moments_of(values), 1e-9);
}

TEST(MomentsOf, NothingAndConstants) {
  expect_same_bits(Moments::of({}), Moments{});
  const std::vector<double> same(100, 0.1);
  EXPECT_NEAR(Moments::of(same).mean(), 0.1, 1e-17);
  EXPECT_LE(Moments::of(same).variance(), 1e-33);
  EXPECT_GE(Moments::of(same).variance(), 0.0);
}

TEST(MomentsMerge, AnySplitGivesTheWhole) {
  const std::vector<double> values = skewed_values(500);
  const Moments whole = moments_of(values);
  for (std::size_t cut = 0; cut <= values.size(); ++cut) {
    Moments merged = moments_of(std::span(values).first(cut));
    merged.merge(moments_of(std::span(values).subspan(cut)));
    expect_same(merged, whole, 1e-12);
  }
}

TEST(MomentsMerge, ManyUnequalPiecesGiveTheWhole) {
  const std::vector<double> values = skewed_values(5000);
  Moments merged;
  for (std::size_t first = 0, size = 1; first < values.size(); first += size, size = size * 2 + 1) {
    merged.merge(moments_of(std::span(values).subspan(first, std::min(size, values.size() - first))));
  }
  expect_same(merged, moments_of(values), 1e-12);
}

TEST(MomentsMerge, LargeOffsetKeepsTheSpread) {
  std::vector<double> values = skewed_values(2000);
  for (double& value : values) value += 1e6;
  Moments merged = moments_of(std::span(values).first(700));
  merged.merge(moments_of(std::span(values).subspan(700)));
  // A mean near 1e6 has rounding errors of 1e-10.
  expect_same(merged, moments_of(values), 1e-9);
}

TEST(MomentsMerge, EmptyChangesNotOneBit) {
  const Moments moments = moments_of(skewed_values(100));
  Moments right = moments;
  right.merge(Moments());
  expect_same_bits(right, moments);
  Moments left;
  left.merge(moments);
  expect_same_bits(left, moments);
}

TEST(MomentsMerge, SameOrderGivesTheSameBits) {
  const std::vector<double> values = skewed_values(1000);
  const auto in_pieces = [&values](std::size_t size) {
    Moments merged;
    for (std::size_t first = 0; first < values.size(); first += size) {
      merged.merge(moments_of(std::span(values).subspan(first, std::min(size, values.size() - first))));
    }
    return merged;
  };
  expect_same_bits(in_pieces(128), in_pieces(128));
}

TEST(MomentsMerge, EqualValuesInPiecesHaveExactlyNoSpread) {
  Moments merged = moments_of(std::vector<double>(3, 0.1));
  merged.merge(moments_of(std::vector<double>(1000, 0.1)));
  EXPECT_EQ(merged.variance(), 0.0);
}

TEST(MomentsAdd, OneValueEqualsMergingIt) {
  const std::vector<double> values = skewed_values(300);
  Moments merged;
  for (const double value : values) merged.merge(moments_of({&value, 1}));
  expect_same(merged, moments_of(values), 1e-12);
}

}  // namespace
}  // namespace poesy
