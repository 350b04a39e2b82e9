#include "engine/stats/buckets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "engine/random/distribution.h"
#include "engine/random/normal_quantile.h"

namespace poesy {
namespace {

constexpr std::size_t kBins = 128;

/// Quantiles of a normal distribution at equal steps of probability: values without random noise.
std::vector<double> normal_values(double mean, double sigma, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(mean + sigma * normal_quantile(1.0, (k + 0.5) / count));
  return values;
}

Histogram histogram_of(const std::vector<double>& values) {
  QuantileSketch sketch;
  sketch.add(values);
  return histogram(sketch.buckets(), kBins);
}

std::vector<std::vector<double>> examples() {
  std::vector<double> folded = normal_values(0.0, 1e-3, 20000);
  for (double& value : folded) value = std::abs(value);
  std::vector<double> two_groups = normal_values(1.0, 1e-3, 5000);
  for (const double value : normal_values(5.0, 0.1, 5000)) two_groups.push_back(value);
  std::vector<double> far_away = normal_values(0.0, 1.0, 20000);
  far_away.back() = 1e6;
  return {normal_values(0.0, 2.0, 20000), folded, two_groups, far_away, {3.0, 3.0, 3.0}, {0.0, 0.0}, {-1.0, 1.0}};
}

TEST(Histogram, CountsEveryValueBetweenTheExtremes) {
  for (const std::vector<double>& values : examples()) {
    const Histogram found = histogram_of(values);
    ASSERT_EQ(found.edges.size(), kBins + 1);
    ASSERT_EQ(found.counts.size(), kBins);
    EXPECT_TRUE(std::ranges::is_sorted(found.edges));
    EXPECT_EQ(found.edges.front(), std::ranges::min(values));
    EXPECT_EQ(found.edges.back(), std::ranges::max(values));
    EXPECT_EQ(std::accumulate(found.counts.begin(), found.counts.end(), std::uint64_t{0}), values.size());
  }
}

/// At every edge, the counts of the bins below add up to the number of values below the edge.
TEST(Histogram, IsExactAtItsEdges) {
  for (const std::vector<double>& values : examples()) {
    const Histogram found = histogram_of(values);
    std::uint64_t below = 0;
    for (std::size_t b = 0; b + 1 < kBins; ++b) {
      below += found.counts[b];
      const double edge = found.edges[b + 1];
      if (edge == found.edges.back()) break;
      const auto under = std::ranges::count_if(values, [&](double value) { return value < edge; });
      const auto at = std::ranges::count(values, edge);
      EXPECT_GE(below, static_cast<std::uint64_t>(under)) << b;
      EXPECT_LE(below, static_cast<std::uint64_t>(under + at)) << b;
    }
  }
}

TEST(Histogram, HasTheShapeOfTheDistribution) {
  const Histogram found = histogram_of(normal_values(0.0, 2.0, 200000));
  for (std::size_t b = 1; b + 1 < kBins; ++b) {
    const double low = found.edges[b];
    const double high = found.edges[b + 1];
    if (!(low < high) || high == found.edges.back()) continue;
    const double share = 0.5 * (std::erf(high / 2.0 / std::sqrt(2.0)) - std::erf(low / 2.0 / std::sqrt(2.0)));
    EXPECT_NEAR(static_cast<double>(found.counts[b]) / 200000.0, share, 2e-5) << b;
  }
}

/// One value that is a million standard deviations away does not force all other values into one bin.
TEST(Histogram, IsNotRuledByAnOutlier) {
  const Histogram found = histogram_of(examples()[3]);
  EXPECT_GT(std::ranges::count_if(found.counts, [](std::uint64_t count) { return count > 0; }), 100);
}

}  // namespace
}  // namespace poesy
