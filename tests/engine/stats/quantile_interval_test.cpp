#include "engine/stats/buckets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace poesy {
namespace {

/// P(B <= k) for a binomial B(n, p), as a sum of its terms.
double binomial_below(std::uint64_t k, std::uint64_t n, double p) {
  double sum = 0.0;
  for (std::uint64_t j = 0; j <= k; ++j) {
    const auto real_j = static_cast<double>(j);
    const auto real_n = static_cast<double>(n);
    const double log_ways = std::lgamma(real_n + 1.0) - std::lgamma(real_j + 1.0) - std::lgamma(real_n - real_j + 1.0);
    sum += std::exp(log_ways + real_j * std::log(p) + (real_n - real_j) * std::log1p(-p));
  }
  return sum;
}

TEST(QuantileRanks, AreTheInnermostThatHoldTheLevelOnEitherSide) {
  for (const std::uint64_t n : {1u, 2u, 10u, 73u, 1000u}) {
    for (const double q : {0.05, 0.5, 0.95, 0.9973}) {
      for (const double level : {0.5, 0.9, 0.95}) {
        const double beyond = 0.5 * (1.0 - level);
        const RankInterval ranks = quantile_ranks(n, q, level);
        ASSERT_LE(ranks.low, n);
        ASSERT_LE(ranks.high, n + 1);
        // P(B < low) is small enough, but P(B < low + 1) is not.
        if (ranks.low > 0) {
          EXPECT_LE(binomial_below(ranks.low - 1, n, q), beyond) << n << " " << q;
        }
        EXPECT_GT(binomial_below(ranks.low, n, q), beyond * (1.0 - 1e-9)) << n << " " << q;
        // P(B >= high) is small enough, but P(B >= high - 1) is not.
        EXPECT_GE(binomial_below(ranks.high - 1, n, q), 1.0 - beyond - 1e-12) << n << " " << q;
        if (ranks.high > 1) {
          EXPECT_LT(binomial_below(ranks.high - 2, n, q), 1.0 - beyond + 1e-12) << n << " " << q;
        }
      }
    }
  }
}

/// 0.9973^1364 is above 0.025, but 0.9973^1365 is not. So 1364 draws are too few for an upper end: its rank is n + 1.
TEST(QuantileRanks, HaveNoUpperEndWhereDrawsAreTooFew) {
  EXPECT_EQ(quantile_ranks(1364, 0.9973, 0.95).high, 1365u);
  EXPECT_EQ(quantile_ranks(1365, 0.9973, 0.95).high, 1365u);
  EXPECT_EQ(quantile_ranks(0, 0.5, 0.95).low, 0u);
  EXPECT_EQ(quantile_ranks(0, 0.5, 0.95).high, 1u);
}

QuantileSketch sketch_of(const std::vector<double>& values) {
  QuantileSketch sketch;
  sketch.add(values);
  return sketch;
}

TEST(QuantileInterval, HoldsItsOrderStatisticsAndHardlyMore) {
  std::vector<double> values;
  for (int k = 1; k <= 500; ++k) values.push_back(k % 2 == 0 ? 1.0 + k / 300.0 : -0.1 - k / 1000.0);
  const QuantileSketch sketch = sketch_of(values);
  std::ranges::sort(values);
  const std::vector<Bucket> buckets = sketch.buckets();
  for (std::uint64_t low = 1; low < 500; low += 13) {
    const std::uint64_t high = std::min<std::uint64_t>(500, low + 40);
    const Interval interval = quantile_interval(buckets, {low, high});
    EXPECT_LE(interval.low, values[low - 1]);
    EXPECT_GE(interval.high, values[high - 1]);
    constexpr double kBucket = 2.0 * QuantileSketch::kRelativeError;
    EXPECT_GE(interval.low, values[low - 1] - kBucket * std::abs(values[low - 1]));
    EXPECT_LE(interval.high, values[high - 1] + kBucket * std::abs(values[high - 1]));
  }
}

TEST(QuantileInterval, IsOpenWhereThereIsNoOrderStatistic) {
  const QuantileSketch sketch = sketch_of({1.0, 2.0, 3.0});
  const Interval open = quantile_interval(sketch.buckets(), {0, 4});
  EXPECT_TRUE(std::isinf(open.low) && open.low < 0.0);
  EXPECT_TRUE(std::isinf(open.high) && open.high > 0.0);
  EXPECT_EQ(quantile_interval(sketch.buckets(), {1, 3}).low, 1.0);
  EXPECT_EQ(quantile_interval(sketch.buckets(), {1, 3}).high, 3.0);
  const Interval none = quantile_interval(QuantileSketch().buckets(), {0, 1});
  EXPECT_TRUE(std::isnan(none.low) && std::isnan(none.high));
}

}  // namespace
}  // namespace poesy
