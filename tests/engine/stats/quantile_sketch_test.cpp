#include "engine/stats/quantile_sketch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/stats/buckets.h"

namespace poesy {
namespace {

QuantileSketch of(const std::vector<double>& values) {
  QuantileSketch sketch;
  sketch.add(values);
  return sketch;
}

TEST(QuantileSketch, KnowsNothingWithoutNumbers) {
  const QuantileSketch empty;
  EXPECT_EQ(empty.count(), 0u);
  for (const double value : {empty.min(), empty.max(), empty.quantile(0.5)}) EXPECT_TRUE(std::isnan(value));
}

TEST(QuantileSketch, IsExactForOneNumberAndForConstants) {
  for (const double value : {0.0, 1.0, -3.7e-9, 1.7976931348623157e308, 5e-324}) {
    for (const std::size_t count : {1u, 2u, 100u}) {
      const QuantileSketch sketch = of(std::vector<double>(count, value));
      for (const double q : {0.0, 0.3, 0.5, 1.0}) EXPECT_EQ(sketch.quantile(q), value) << value;
    }
  }
}

TEST(QuantileSketch, IsExactForZeroAndForTheExtremes) {
  const QuantileSketch sketch = of({-3.3, 0.0, 0.0, -0.0, 7.7});
  EXPECT_EQ(sketch.count(), 5u);
  EXPECT_EQ(sketch.quantile(0.0), -3.3);
  EXPECT_EQ(sketch.quantile(0.5), 0.0);
  EXPECT_EQ(sketch.quantile(0.8), 0.0);
  EXPECT_EQ(sketch.quantile(1.0), 7.7);
  EXPECT_EQ(sketch.min(), -3.3);
  EXPECT_EQ(sketch.max(), 7.7);
}

/// `times` copies of each value.
std::vector<double> repeated(const std::vector<double>& values, std::size_t times) {
  std::vector<double> all;
  for (const double value : values) all.insert(all.end(), times, value);
  return all;
}

TEST(QuantileSketch, TellsItsBucketsFromBelow) {
  const std::vector<double> values{-3.3, 0.0, 1.5, 1e6};
  for (const std::size_t times : {2u, 100u}) {  // few values are stored, many are counted in buckets
    const std::vector<Bucket> buckets = of(repeated(values, times)).buckets();
    ASSERT_EQ(buckets.size(), values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      EXPECT_EQ(buckets[k].count, times);
      EXPECT_EQ(buckets[k].up_to, (k + 1) * times);
      EXPECT_LE(buckets[k].lower, values[k]);
      EXPECT_GE(buckets[k].upper, values[k]);
      EXPECT_LE(buckets[k].upper - buckets[k].lower, std::abs(buckets[k].lower) * 2.0 * QuantileSketch::kRelativeError);
    }
    EXPECT_EQ(buckets.front().lower, values.front());
    EXPECT_EQ(buckets.back().upper, values.back());
    EXPECT_EQ(buckets[1].upper, 0.0);
  }
}

TEST(QuantileSketch, KeepsFewNumbersAsTheyAre) {
  std::vector<double> values;
  for (int k = 0; k < 256; ++k) values.push_back(std::sin(k) / 3.0);
  QuantileSketch sketch = of(values);
  std::ranges::sort(values);
  for (std::uint64_t k = 1; k <= 256; ++k) {
    EXPECT_EQ(sketch.order_statistic(k), values[k - 1]);
    EXPECT_EQ(order_statistic_error(sketch.buckets(), k), 0.0);
  }
  sketch.add(std::vector{0.1234});
  EXPECT_GT(order_statistic_error(sketch.buckets(), 100), 0.0);
}

TEST(QuantileSketch, FoldsMagnitudesTogether) {
  for (const std::size_t times : {1u, 100u}) {
    const QuantileSketch magnitudes = of(repeated({-8.0, -2.0, -0.5, 0.0, 1.0, 4.0}, times)).magnitudes();
    EXPECT_EQ(magnitudes.count(), 6u * times);
    EXPECT_EQ(magnitudes.max(), 8.0);
    EXPECT_EQ(magnitudes.min(), 0.0);
    for (std::uint64_t k = 2; k <= 6; ++k) {
      const double truth = std::ldexp(1.0, static_cast<int>(k) - 3);  // 0.5, 1, 2, 4, 8
      EXPECT_NEAR(magnitudes.order_statistic(k * times), truth, truth * QuantileSketch::kRelativeError);
    }
    EXPECT_EQ(of(repeated({-8.0, -2.0}, 2 * times)).magnitudes().min(), 2.0);
    EXPECT_EQ(of(repeated({-8.0, 5.0}, 2 * times)).magnitudes().min(), 5.0);
    EXPECT_EQ(of(repeated({3.0, 5.0}, 2 * times)).magnitudes().min(), 3.0);
  }
  EXPECT_EQ(QuantileSketch().magnitudes().count(), 0u);
}

TEST(NumberBlock, KnowsItsExtremes) {
  const NumberBlock none(std::span<const double>{});
  EXPECT_TRUE(none.values.empty());
  EXPECT_GT(none.extremes.min, none.extremes.max);
  EXPECT_FALSE(none.extremes.has_above());
  EXPECT_FALSE(none.extremes.has_below());

  std::vector<double> values(37, 1.5);
  values[5] = -8.0;
  values[6] = 0.0;
  values[7] = -1e-310;
  values[36] = -0.25;
  const Extremes extremes = NumberBlock(values).extremes;
  EXPECT_EQ(extremes.count, values.size());
  EXPECT_EQ(extremes.min, -8.0);
  EXPECT_EQ(extremes.max, 1.5);
  EXPECT_EQ(extremes.least_above, 1.5);
  EXPECT_EQ(extremes.least_below, 0.25);
  EXPECT_FALSE(NumberBlock(std::vector{0.0, -1e-310, 1e-310}).extremes.has_above());
}

TEST(QuantileSketch, TakesSubnormalsForZeroWhereItCounts) {
  EXPECT_EQ(of({-5e-324, 1e-310, 2e-310, 3e-310, 1.0}).quantile(0.6), 2e-310);
  const QuantileSketch sketch = of(repeated({-5e-324, 1e-310, 2e-310, 3e-310, 1.0}, 100));
  EXPECT_EQ(sketch.quantile(0.6), 0.0);
  EXPECT_EQ(sketch.min(), -5e-324);
}

TEST(QuantileSketch, DoesNotLoseARankToRounding) {
  std::vector<double> values;
  for (int k = 1; k <= 100; ++k) values.push_back(k);
  const QuantileSketch sketch = of(values);
  // In doubles 0.07 * 100 is 7.000000000000001, whose ceiling would be rank 8.
  EXPECT_NEAR(sketch.quantile(0.07), 7.0, 7.0 * QuantileSketch::kRelativeError);
  for (int k = 1; k <= 100; ++k) {
    EXPECT_NEAR(sketch.quantile(k / 100.0), k, k * QuantileSketch::kRelativeError) << k;
  }
}

/// Values that need few pages have a fine bucket each, even if they differ by only 0x1p-44.
TEST(QuantileSketch, IsExactForAFewNumbersThatComeOften) {
  const std::vector<double> atoms{-1.0 / 3.0, 1.0, 1.0 + 0x1p-44, 1.5, 3.0};
  const QuantileSketch sketch = of(repeated(atoms, 1000));
  for (std::size_t k = 0; k < atoms.size(); ++k) {
    EXPECT_NEAR(sketch.order_statistic(1000 * k + 500), atoms[k], 4e-5) << k;
  }
  EXPECT_EQ(of(repeated({1.0, 1.0 + 0x1p-44}, 1000)).buckets().size(), 2u);
}

}  // namespace
}  // namespace poesy
