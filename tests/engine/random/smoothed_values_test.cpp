#include "engine/random/smoothed_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "engine/random/stream.h"

namespace poesy {
namespace {

struct TwoMoments {
  double mean;
  double deviation;
};

/// Mean and standard deviation of a sample, with the divisor n - 1.
TwoMoments of_sample(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (n - 1.0))};
}

/// Mean and standard deviation of f(x) over the distribution of `parts`, by the midpoint rule over the probability.
template <class Function>
TwoMoments of_draws(const SmoothedValues& parts, const Function& f) {
  constexpr int kSteps = 2'000'000;
  double sum = 0.0;
  double squares = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double x = f(parts.quantile((k + 0.5) / kSteps));
    sum += x;
    squares += x * x;
  }
  return {sum / kSteps, std::sqrt(squares / kSteps - sum * sum / kSteps / kSteps)};
}

double identity(double x) { return x; }

/// Random values. By the seed they are skewed, in groups of equal values, or symmetric with long tails.
std::vector<double> some_values(std::size_t count, std::uint64_t seed) {
  std::vector<double> values(count);
  fill_uniforms({seed, Purpose::error_samples, FactorIndex(0), PoseIndex(0)}, SampleIndex(0), values);
  for (double& u : values) {
    u = seed % 3 == 0 ? std::log(u) : seed % 3 == 1 ? std::round(8.0 * u) : std::tan(1.4 * (2.0 * u - 1.0));
  }
  return values;
}

TEST(SmoothedValues, HaveMeanAndDeviationOfTheSample) {
  for (const std::size_t count : {8U, 9U, 20U, 41U, 100U}) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const std::vector<double> values = some_values(count, seed);
      const SmoothedValues parts(values);
      const auto [mean, deviation] = of_sample(values);
      EXPECT_NEAR(parts.mean(), mean, 1e-13 * deviation);
      EXPECT_NEAR(parts.standard_deviation(), deviation, 1e-12 * deviation) << count << ' ' << seed;
      const TwoMoments drawn = of_draws(parts, identity);
      EXPECT_NEAR(drawn.mean, mean, 1e-4 * deviation);
      EXPECT_NEAR(drawn.deviation, deviation, 1e-3 * deviation);
    }
  }
}

/// One of ten parts is far from the others. The magnitudes too have about the mean and the standard deviation of the
/// parts.
TEST(SmoothedValues, AreRightWhereOnePartStandsApart) {
  const std::vector<double> values{0.0, 0.0, 0.0, 0.0, 0.0, 0.001, 0.001, 0.001, 0.001, 0.5};
  const TwoMoments drawn = of_draws(SmoothedValues(values), [](double x) { return std::abs(x); });
  EXPECT_NEAR(drawn.mean, 0.0504, 1e-5);
  EXPECT_NEAR(drawn.deviation, of_sample(values).deviation, 1e-4);
}

TEST(SmoothedValues, SpreadByTheDistanceOfNeighbours) {
  const std::vector<double> values{3.0, 1.0, 4.0, 1.5, 9.0, 2.5, 5.0, 3.5};
  const SmoothedValues parts(values);
  std::vector<double> ratio;
  double squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::vector<double> distance;
    for (const double other : values) distance.push_back(std::abs(other - values[i]));
    std::ranges::sort(distance);
    ratio.push_back(parts.half_widths()[i] / distance.at(3));  // third neighbour: ceil(sqrt(8)) = 3; at(0) is the value
    squares += parts.half_widths()[i] * parts.half_widths()[i] / 3.0;
  }
  for (const double one : ratio) EXPECT_NEAR(one, ratio.front(), 1e-12);
  const double deviation = of_sample(values).deviation;
  EXPECT_NEAR(squares / 8.0, deviation * deviation / 8.0, 1e-12);
  EXPECT_EQ(parts.greatest(), 9.0 + parts.half_widths()[4]);
  EXPECT_GT(parts.share(9.0), 1.0 - 1.5 / 8.0);
  EXPECT_NEAR(1.0 - parts.share(9.0), 0.5 / 8.0, 1e-12);
}

TEST(SmoothedValues, HaveAQuantileThatIsTheInverseOfTheShare) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const SmoothedValues parts(some_values(40, seed));
    double before = parts.least();
    for (int k = 0; k < 10'007; ++k) {
      const double u = (k + 0.5) / 10'007;
      const double x = parts.quantile(u);
      EXPECT_GE(x, before);
      EXPECT_LE(x, parts.greatest());
      before = x;
      // A value that is not spread has a probability of its own, so its share is not unique.
      const auto [low, high] = std::equal_range(parts.knots().begin(), parts.knots().end(), x);
      if (high - low > 1) continue;
      EXPECT_NEAR(parts.share(x), u, 1e-12);
    }
    EXPECT_EQ(parts.share(parts.least() - 1.0), 0.0);
    EXPECT_EQ(parts.share(parts.greatest() + 1.0), 1.0);
    EXPECT_GE(parts.quantile(0x1p-54), parts.least());
    EXPECT_LE(parts.quantile(1.0 - 0x1p-53), parts.greatest());
  }
}

TEST(SmoothedValues, AreTheSameInAnyOrder) {
  std::vector<double> values = some_values(40, 2);
  const SmoothedValues parts(values);
  std::ranges::sort(values);
  const SmoothedValues sorted(values);
  EXPECT_TRUE(std::ranges::equal(parts.knots(), sorted.knots()));
  EXPECT_TRUE(std::ranges::equal(parts.shares(), sorted.shares()));
  EXPECT_FALSE(parts == sorted);
}

TEST(SmoothedValues, OfTwoKindsSpread) {
  const SmoothedValues parts({0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0});
  EXPECT_NEAR(parts.standard_deviation(), std::sqrt(2.0 / 7.0), 1e-14);
  EXPECT_GT(parts.half_widths()[0], 0.0);
}

}  // namespace
}  // namespace poesy
