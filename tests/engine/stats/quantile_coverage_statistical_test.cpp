#include <gtest/gtest.h>

#include <boost/random/lognormal_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "engine/stats/buckets.h"

// Coverage of the 95 % interval of a quantile that is known in closed form, in repeated experiments with fixed seeds. z
// is the distance of the observed coverage from 0.95 in its standard errors. A correct interval fails with probability
// alpha = 0.001 (z < -3.090). Ranks are whole numbers and the ends lie at the outer edges of buckets, so the coverage
// may be above 0.95. If neither matters, the check is two-sided (|z| > 3.291).

namespace poesy {
namespace {

constexpr double kLevel = 0.95;
constexpr int kRepetitions = 4000;

using Draw = std::function<double(boost::random::mt19937_64&)>;

double z_of_coverage(const Draw& draw, double q, double truth, int samples, std::uint64_t seed) {
  boost::random::mt19937_64 engine(seed);
  const RankInterval ranks = quantile_ranks(static_cast<std::uint64_t>(samples), q, kLevel);
  int hits = 0;
  std::vector<double> values(static_cast<std::size_t>(samples));
  for (int r = 0; r < kRepetitions; ++r) {
    for (double& value : values) value = draw(engine);
    QuantileSketch sketch;
    sketch.add(values);
    const Interval interval = quantile_interval(sketch.buckets(), ranks);
    hits += interval.low <= truth && truth <= interval.high ? 1 : 0;
  }
  const double share = static_cast<double>(hits) / kRepetitions;
  testing::Test::RecordProperty("coverage_" + std::to_string(samples), std::to_string(share));
  return (share - kLevel) / std::sqrt(kLevel * (1.0 - kLevel) / kRepetitions);
}

double folded_normal(boost::random::mt19937_64& engine) {
  return std::abs(boost::random::normal_distribution<double>()(engine));
}

// The quantile q of |N(0, 1)| is the quantile (1 + q) / 2 of N(0, 1).
TEST(QuantileInterval, CoversTheMedianOfAFoldedNormalOnly) {
  EXPECT_LE(std::abs(z_of_coverage(folded_normal, 0.5, 0.6744897501961, 1000, 21)), 3.291);
}

TEST(QuantileInterval, CoversTheHighQuantilesOfAFoldedNormal) {
  EXPECT_GE(z_of_coverage(folded_normal, 0.95, 1.9599639845401, 1000, 22), -3.090);
  EXPECT_GE(z_of_coverage(folded_normal, 0.9973, 2.9999769927034, 3000, 23), -3.090);
}

/// With too few samples the interval has no upper end. Then it misses the quantile in at most 2.5 % of the repetitions.
TEST(QuantileInterval, CoversWhereItHasNoUpperEnd) {
  EXPECT_GE(z_of_coverage(folded_normal, 0.9973, 2.9999769927034, 500, 24), -3.090);
}

/// exp(2 N) with a standard normal N is skewed and has an enormous kurtosis.
TEST(QuantileInterval, CoversTheQuantilesOfALogNormal) {
  const Draw draw = [](boost::random::mt19937_64& engine) {
    return boost::random::lognormal_distribution<double>(0.0, 2.0)(engine);
  };
  EXPECT_GE(z_of_coverage(draw, 0.5, 1.0, 400, 25), -3.090);
  EXPECT_GE(z_of_coverage(draw, 0.99, std::exp(2.0 * 2.3263478740408), 2000, 26), -3.090);
}

/// A signed response whose quantile is below zero.
TEST(QuantileInterval, CoversAQuantileBelowZero) {
  const Draw draw = [](boost::random::mt19937_64& engine) {
    return boost::random::normal_distribution<double>()(engine);
  };
  EXPECT_GE(z_of_coverage(draw, 0.05, -1.6448536269515, 1000, 27), -3.090);
}

/// Fixed numbers of draws from two distributions, as at several poses. The interval is then wider than necessary.
TEST(QuantileInterval, CoversThatOfAMixtureInFixedShares) {
  int drawn = 0;
  const Draw draw = [&drawn](boost::random::mt19937_64& engine) {
    return (drawn++ % 2 == 0 ? 0.0 : 10.0) + boost::random::normal_distribution<double>()(engine);
  };
  // Half of the mixture is below 5, so a quarter is below 0, the mean of the first distribution.
  EXPECT_GE(z_of_coverage(draw, 0.25, 0.0, 1000, 28), -3.090);
}

}  // namespace
}  // namespace poesy
