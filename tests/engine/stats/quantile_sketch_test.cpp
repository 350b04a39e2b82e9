#include "engine/stats/quantile_sketch.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(QuantileSketch, TellsItsBucketsFromBelow) {
  const std::vector<Bucket> buckets = of({-3.3, -3.3, 0.0, 1e-310, 1.5, 7.71, 7.712}).buckets();
  ASSERT_EQ(buckets.size(), 4u);
  const std::vector<std::uint64_t> counts{2, 2, 1, 2};
  std::uint64_t up_to = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(buckets[k].count, counts[k]);
    EXPECT_EQ(buckets[k].up_to, up_to += counts[k]);
    EXPECT_LE(buckets[k].upper - buckets[k].lower, std::abs(buckets[k].upper) * 2.0 * QuantileSketch::kRelativeError);
  }
  EXPECT_EQ(buckets[0].lower, -3.3);
  EXPECT_GE(buckets[0].upper, -3.3);
  EXPECT_EQ(buckets[1].lower, 0.0);
  EXPECT_EQ(buckets[1].upper, 0.0);
  EXPECT_LE(buckets[2].lower, 1.5);
  EXPECT_GT(buckets[2].upper, 1.5);
  EXPECT_EQ(buckets[3].upper, 7.712);
}

TEST(QuantileSketch, FoldsMagnitudesTogether) {
  const QuantileSketch magnitudes = of({-8.0, -2.0, -0.5, 0.0, 1.0, 4.0}).magnitudes();
  EXPECT_EQ(magnitudes.count(), 6u);
  EXPECT_EQ(magnitudes.max(), 8.0);
  for (std::uint64_t k = 2; k <= 6; ++k) {
    const double truth = std::ldexp(1.0, static_cast<int>(k) - 3);  // 0.5, 1, 2, 4, 8
    EXPECT_NEAR(magnitudes.order_statistic(k), truth, truth * QuantileSketch::kRelativeError);
  }
  EXPECT_EQ(of({-8.0, -2.0}).magnitudes().min(), 2.0);
  EXPECT_EQ(of({3.0, 5.0}).magnitudes().min(), 3.0);
  EXPECT_EQ(QuantileSketch().magnitudes().count(), 0u);
}

TEST(BucketedValues, KnowsItsExtremesAndSigns) {
  const BucketedValues none(std::span<const double>{});
  EXPECT_TRUE(none.buckets.empty());
  EXPECT_GT(none.min, none.max);

  std::vector<double> values(37, 1.5);
  values[5] = -8.0;
  values[6] = 0.0;
  values[7] = -1e-310;
  values[36] = -0.25;
  const BucketedValues bucketed(values);
  EXPECT_EQ(bucketed.buckets.size(), values.size());
  EXPECT_EQ(bucketed.buckets[5], 0x80000u + 0x402u * 256u);  // the sign, the exponent 3, no fraction
  EXPECT_EQ(bucketed.lowest, 0x3fdu * 256u);
  EXPECT_EQ(bucketed.highest, 0x402u * 256u);
  EXPECT_EQ(bucketed.negatives, 2u);
  EXPECT_EQ(bucketed.positives, 33u);
  EXPECT_EQ(bucketed.min, -8.0);
  EXPECT_EQ(bucketed.max, 1.5);
}

TEST(QuantileSketch, TakesSubnormalsForZero) {
  const QuantileSketch sketch = of({-5e-324, 1e-310, 2e-310, 3e-310, 1.0});
  EXPECT_EQ(sketch.quantile(0.6), 0.0);
  EXPECT_EQ(sketch.min(), -5e-324);
}

TEST(QuantileSketch, DoesNotLoseARankToRounding) {
  std::vector<double> values;
  for (int k = 1; k <= 100; ++k) values.push_back(k);
  const QuantileSketch sketch = of(values);
  // 0.07 * 100 is 7.000000000000001 in doubles, and its ceiling 8.
  EXPECT_NEAR(sketch.quantile(0.07), 7.0, 7.0 * QuantileSketch::kRelativeError);
  for (int k = 1; k <= 100; ++k) {
    EXPECT_NEAR(sketch.quantile(k / 100.0), k, k * QuantileSketch::kRelativeError) << k;
  }
}

TEST(QuantileSketch, ReachesItsStatedErrorAtABucketsEdge) {
  const QuantileSketch sketch = of({0.5, 1.0, 2.0});
  EXPECT_EQ(sketch.quantile(0.5), 1.0 + QuantileSketch::kRelativeError);
}

}  // namespace
}  // namespace poesy
