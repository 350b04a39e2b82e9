#include "engine/stats/first_order.h"
#include "engine/random/normal_quantile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/engine/stats/effect_functions.h"

namespace poesy {
namespace {

using test::EffectExperiment;
using test::EffectFunction;

constexpr double kIshigamiVariance = 13.844587940719254;

double truth_of_bins(const EffectFunction& function, std::size_t error, std::size_t bins) {
  std::array<double, kEffectBins> means = test::bin_means(function, error);
  Moments of_bins;
  for (std::size_t b = 0; b < kEffectBins; b += kEffectBins / bins) {
    of_bins.add(std::accumulate(&means[b], &means[b] + kEffectBins / bins, 0.0) * static_cast<double>(bins) /
                kEffectBins);
  }
  return of_bins.variance() * static_cast<double>(bins - 1) / static_cast<double>(bins);
}

/// The binned variance for practically infinitely many samples: the main effect of `error`, with equal variance in each
/// bin. total: variance of the function.
BinnedVariance without_noise(const EffectFunction& function, std::size_t error, double total, const BinSpread& spread) {
  constexpr double kSamples = 1e14;
  const std::array<double, kEffectBins> means = test::bin_means(function, error);
  const double within = total - truth_of_bins(function, error, kEffectBins);
  std::array<BinSums, kEffectBins> sums;
  for (std::size_t b = 0; b < kEffectBins; ++b) {
    sums[b] = {kSamples, kSamples * means[b], kSamples * (means[b] * means[b] + within)};
  }
  Moments all;
  for (int k = 0; k < 1000; ++k) all.add(k);  // enough for 32 bins; the values do not matter
  return binned_variance(sums, all, spread);
}

TEST(BinnedVariance, OfStepsHasTheReferenceValues) {
  const EffectFunction ishigami = test::ishigami();
  const std::array<double, 2> expected{.31289798, .43675484};
  for (std::size_t p = 0; p < 2; ++p) {
    const BinnedVariance found = without_noise(ishigami, p, kIshigamiVariance, {});
    EXPECT_NEAR(found.between / kIshigamiVariance, expected[p], 1e-7);
    EXPECT_NEAR(found.total, kIshigamiVariance, 1e-9 * kIshigamiVariance);
  }
}

TEST(BinnedVariance, OfLinesHasTheBiasThatItStates) {
  const auto bias = [](const EffectFunction& function, std::size_t error, double total) {
    const BinnedVariance found = without_noise(function, error, total, test::spread_of(function.distribution));
    return found.between / total / function.first_order[error] - 1.0;
  };
  EXPECT_NEAR(bias(test::linear({1.0}), 0, 1.0), 0.0, 1e-6);
  EXPECT_NEAR(bias(test::ishigami(), 0, kIshigamiVariance), -0.6e-4, 1e-5);
  EXPECT_NEAR(bias(test::ishigami(), 1, kIshigamiVariance), -5.7e-4, 1e-5);
  const double folded = 1.0 - 2.0 / std::numbers::pi;
  EXPECT_NEAR(bias(test::folded(), 0, folded), -1.5e-5, 2e-5);
  EXPECT_NEAR(bias(test::folded(), 1, folded), -1.57e-2, 1e-4);
  const auto exponential = [&](double size) {
    return bias(test::exponential(size, {1.0}), 0, std::exp(size * size) * std::expm1(size * size));
  };
  EXPECT_NEAR(exponential(0.5), -1.3e-2, 1e-3);
  EXPECT_NEAR(exponential(1.0), -0.114, 2e-3);
}

TEST(BinSpread, IsThatOfTheDistribution) {
  const BinSpread normal = test::spread_of(Distribution::normal(2.0));
  // E[z | z > q] = 32 phi(q) and E[z^2 | z > q] = 1 + 32 q phi(q), with the standard normal density phi and its
  // quantile q for 31/32.
  const double q = normal_quantile(1.0, 31.0 / 32.0);
  const double mean = 32.0 * std::exp(-0.5 * q * q) / std::sqrt(2.0 * std::numbers::pi);
  EXPECT_NEAR(normal.mean[31], 2.0 * mean, 1e-4);
  EXPECT_NEAR(normal.variance[31], 4.0 * (1.0 + q * mean - mean * mean), 5e-4);
  EXPECT_GT(normal.third[31], 0.0);
  EXPECT_NEAR(normal.mean[0], -normal.mean[31], 1e-12);
  EXPECT_NEAR(normal.third[0], -normal.third[31], 1e-12);
  const BinSpread uniform = test::spread_of(Distribution::uniform(16.0));
  for (std::size_t b = 0; b < kEffectBins; ++b) {
    EXPECT_NEAR(uniform.mean[b], static_cast<double>(b) - 15.5, 1e-12);
    EXPECT_NEAR(uniform.variance[b], 1.0 / 12.0, 5e-6);
    EXPECT_NEAR(uniform.third[b], 0.0, 1e-12);
  }
}

/// Difference of an estimate's mean over repetitions from the truth, in standard errors.
template <class Value>
double z_of_mean(const Value& value, double truth, int repetitions) {
  Moments values;
  for (int r = 0; r < repetitions; ++r) values.add(value());
  return (values.mean() - truth) / values.standard_deviation() * std::sqrt(repetitions);
}

TEST(BinnedVariance, HasNoBiasButThatOfItsBins) {
  const EffectFunction ishigami = test::ishigami();
  // The number of bins is 32 for 1024 samples, 16 for 256 and 8 for 128.
  const std::array<std::pair<std::size_t, std::array<double, 2>>, 3> cases{
      {{1024, {.31289798, .43675484}}, {256, {.30989186, .42013185}}, {128, {.29809730, .35860497}}}};
  for (const auto& [samples, expected] : cases) {
    for (std::size_t p = 0; p < 2; ++p) {
      EffectExperiment experiment(60 + samples + p);
      const auto between = [&, drawn = samples] { return experiment.sums(ishigami, drawn).variance(0, p, {}).between; };
      EXPECT_LE(std::abs(z_of_mean(between, expected[p] * kIshigamiVariance, 1500)), 3.291) << samples << ' ' << p;
    }
  }
}

TEST(BinnedVariance, OfTheTotalHasNoBias) {
  EffectExperiment experiment(71);
  const EffectFunction ishigami = test::ishigami();
  const auto total = [&] { return experiment.sums(ishigami, 256).variance(0, 2, {}).total; };
  EXPECT_LE(std::abs(z_of_mean(total, kIshigamiVariance, 2000)), 3.291);
}

TEST(BinnedVariance, NeedsSixtyFourSamples) {
  EffectExperiment experiment(72);
  const EffectFunction linear = test::linear({1.0});
  EXPECT_TRUE(std::isnan(experiment.sums(linear, 63).variance(0, 0, {}).between));
  EXPECT_FALSE(std::isnan(experiment.sums(linear, 90).variance(0, 0, {}).between));
}

BinnedVariance of_some_samples(std::uint64_t seed, const std::function<double(double)>& scaled) {
  EffectFunction function = test::folded();
  const auto value = function.value;
  function.value = [=](std::span<const double> z) { return scaled(value(z)); };
  return EffectExperiment(seed).sums(function, 3000).variance(0, 0, test::spread_of(function.distribution));
}

Estimate index_of(const BinnedVariance& variance) {
  return first_order_index(std::span(&variance, 1), Dependence::independent, 0.95);
}

TEST(FirstOrderIndex, DoesNotDependOnUnitAndOrigin) {
  const Estimate plain = index_of(of_some_samples(81, [](double y) { return y; }));
  const Estimate scaled = index_of(of_some_samples(81, [](double y) { return 1e-6 * y - 0.5; }));
  EXPECT_NEAR(scaled.value, plain.value, 1e-8);
  EXPECT_NEAR(scaled.interval.low, plain.interval.low, 1e-8);
  EXPECT_NEAR(scaled.interval.high, plain.interval.high, 1e-8);
}

TEST(FirstOrderIndex, OfAConstantIsNotKnown) {
  const Estimate index = index_of(of_some_samples(82, [](double) { return 0.1; }));
  EXPECT_TRUE(std::isnan(index.value));
  EXPECT_TRUE(std::isnan(index.interval.low));
  EXPECT_TRUE(std::isnan(first_order_index({}, Dependence::unknown, 0.95).value));
}

TEST(FirstOrderIndex, OfSeveralPosesIsTheRatioOfSums) {
  const BinnedVariance a = of_some_samples(83, [](double y) { return y; });
  const BinnedVariance b = of_some_samples(84, [](double y) { return 2.0 * y * y; });
  const Estimate both = first_order_index(std::array{a, b}, Dependence::independent, 0.95);
  EXPECT_DOUBLE_EQ(both.value, (a.between + b.between) / (a.total + b.total));
  const Estimate dependent = first_order_index(std::array{a, b}, Dependence::unknown, 0.95);
  EXPECT_EQ(dependent.value, both.value);
  EXPECT_LT(dependent.interval.low, both.interval.low);
  EXPECT_GT(dependent.interval.high, both.interval.high);
}

TEST(FirstOrderIndex, OfTheSamePoseManyTimesIsThatOfThePose) {
  const BinnedVariance one = of_some_samples(85, [](double y) { return y; });
  const Estimate once = index_of(one);
  const std::vector<BinnedVariance> many(20, one);
  const Estimate dependent = first_order_index(many, Dependence::unknown, 0.95);
  EXPECT_NEAR(dependent.interval.low, once.interval.low, 1e-12);
  EXPECT_NEAR(dependent.interval.high, once.interval.high, 1e-12);
  const Estimate independent = first_order_index(many, Dependence::independent, 0.95);
  EXPECT_LT(independent.interval.high - independent.interval.low, 0.25 * (once.interval.high - once.interval.low));
}

TEST(FirstOrderIndex, IsNotKnownWhereAPartIsNot) {
  const BinnedVariance known = of_some_samples(86, [](double y) { return y; });
  BinnedVariance unknown;
  unknown.between = unknown.total = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(first_order_index(std::array{known, unknown}, Dependence::independent, 0.95).value));
}

}  // namespace
}  // namespace poesy
