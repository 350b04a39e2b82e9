#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/stats/yield_gradient.h"
#include "tests/engine/stats/coverage.h"
#include "tests/engine/stats/effect_functions.h"

// How often 95 % intervals of first-order indices, main effects and gradients of a yield hold the truth.

namespace poesy {
namespace {

using test::Coverage;
using test::EffectExperiment;
using test::EffectFunction;

constexpr double kLevel = 0.95;

/// The intervals of all first-order indices of a function.
std::vector<Coverage> index_coverage(const EffectFunction& function, std::size_t samples, int repetitions,
                                     std::uint64_t seed) {
  EffectExperiment experiment(seed);
  const BinSpread spread = test::spread_of(function.distribution);
  std::vector<Coverage> coverage(function.errors());
  for (int r = 0; r < repetitions; ++r) {
    const MainEffectSums sums = experiment.sums(function, samples);
    for (std::size_t p = 0; p < coverage.size(); ++p) {
      const BinnedVariance variance = sums.variance(0, p, spread);
      coverage[p].add(first_order_index(std::span(&variance, 1), Dependence::independent, kLevel).interval,
                      function.first_order[p]);
    }
  }
  return coverage;
}

/// The intervals of all bins of all curves of a function together, one for each error.
std::vector<Coverage> curve_coverage(const EffectFunction& function, std::size_t samples, int repetitions,
                                     std::uint64_t seed) {
  EffectExperiment experiment(seed);
  std::vector<std::array<double, kEffectBins>> truth;
  for (std::size_t p = 0; p < function.errors(); ++p) truth.push_back(test::bin_means(function, p));
  std::vector<Coverage> coverage(function.errors());
  for (int r = 0; r < repetitions; ++r) {
    const MainEffectSums sums = experiment.sums(function, samples);
    for (std::size_t p = 0; p < coverage.size(); ++p) {
      const auto curve = sums.curve(0, p, kLevel);
      for (std::size_t b = 0; b < kEffectBins; ++b) coverage[p].add(curve[b].interval, truth[p][b]);
    }
  }
  return coverage;
}

/// Four poses at which two errors act in different directions, and at one of them by the magnitude.
struct FourPoses {
  std::vector<EffectFunction> functions{test::linear({.8, .2}), test::linear({.5, .5}), test::linear({.2, .8}),
                                        test::folded()};
  double aggregated() const {
    const double folded = 1.0 - 2.0 / std::numbers::pi;
    return (.8 + .5 + .2 + folded * functions[3].first_order[0]) / (3.0 + folded);
  }
};

Coverage aggregated_coverage(Dependence dependence, std::size_t samples, int repetitions, std::uint64_t seed) {
  EffectExperiment experiment(seed);
  const FourPoses poses;
  const BinSpread spread = test::spread_of(poses.functions[0].distribution);
  Coverage coverage;
  for (int n = 0; n < repetitions; ++n) {
    std::vector<BinnedVariance> parts;
    if (dependence == Dependence::unknown) {
      const MainEffectSums sums = experiment.sums(poses.functions, samples);
      for (std::size_t r = 0; r < poses.functions.size(); ++r) parts.push_back(sums.variance(r, 0, spread));
    } else {
      for (const EffectFunction& pose : poses.functions) {
        parts.push_back(experiment.sums(pose, samples).variance(0, 0, spread));
      }
    }
    coverage.add(first_order_index(parts, dependence, kLevel).interval, poses.aggregated());
  }
  return coverage;
}

/// The gradient of P(|z1 / 10 + ...| <= limit) for the three errors of the reference case (yield_gradient_test.cpp).
Coverage gradient_coverage(double limit, std::size_t machines, int repetitions, std::uint64_t seed) {
  constexpr std::array kSlope{1.0, 2.0, 0.5};
  constexpr std::array kSigma{0.1, 0.05, 0.2};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double deviation = std::sqrt(0.03);
  const double density = std::exp(-0.5 * limit * limit / 0.03) / std::sqrt(2.0 * std::numbers::pi);
  boost::random::mt19937_64 engine(seed);
  std::vector<double> errors(3 * machines);
  std::vector<std::uint8_t> rejected(machines);
  Coverage coverage;
  for (int r = 0; r < repetitions; ++r) {
    for (double& error : errors) error = uniform_from_bits(engine());
    for (std::size_t p = 0; p < 3; ++p) {
      Distribution::normal(kSigma[p]).transform(std::span(errors).subspan(p * machines, machines));
    }
    for (std::size_t b = 0; b < machines; ++b) {
      double y = 0.0;
      for (std::size_t p = 0; p < 3; ++p) y += kSlope[p] * errors[p * machines + b];
      rejected[b] = static_cast<std::uint8_t>(std::abs(y) > limit);
    }
    ScoreSums scores(std::array{ErrorScale{kSigma[0], kInfinity}, ErrorScale{kSigma[1], kInfinity},
                                ErrorScale{kSigma[2], kInfinity}});
    scores.add(errors, rejected);
    const std::vector<Estimate> gradient = scores.gradient(kLevel);
    for (std::size_t p = 0; p < 3; ++p) {
      const double slope = kSlope[p] * kSlope[p] * kSigma[p];
      coverage.add(gradient[p].interval, -2.0 * density * limit * slope / (deviation * deviation * deviation));
    }
  }
  return coverage;
}

constexpr int kRepetitions = 1000;

TEST(FirstOrderIndexInterval, CoversTheLinear) {
  for (const std::size_t samples : {256U, 1024U, 4096U}) {
    const auto coverage = index_coverage(test::linear({.8, .15, .05, 0.0}), samples, kRepetitions, 91 + samples);
    for (const std::size_t p : {1U, 2U}) EXPECT_LE(std::abs(coverage[p].z()), 3.291) << samples << ' ' << p;
    for (const std::size_t p : {0U, 3U}) EXPECT_GE(coverage[p].z(), -3.090) << samples << ' ' << p;
  }
}

TEST(FirstOrderIndexInterval, CoversIndicesNearOne) {
  for (const std::size_t samples : {256U, 4096U}) {
    EXPECT_GE(index_coverage(test::linear({.99, .01}), samples, kRepetitions, 92)[0].z(), -3.090) << samples;
    EXPECT_GE(index_coverage(test::linear({1.0}), samples, kRepetitions, 93)[0].z(), -3.090) << samples;
  }
}

TEST(FirstOrderIndexInterval, CoversIshigami) {
  for (const std::size_t samples : {256U, 1024U, 4096U}) {
    for (const Coverage& coverage : index_coverage(test::ishigami(), samples, kRepetitions, 94 + samples)) {
      EXPECT_GE(coverage.z(), -3.090) << samples;
    }
  }
}

TEST(FirstOrderIndexInterval, CoversTheFolded) {
  for (const std::size_t samples : {256U, 1024U, 4096U}) {
    for (const Coverage& coverage : index_coverage(test::folded(), samples, kRepetitions, 95 + samples)) {
      EXPECT_LE(std::abs(coverage.z()), 3.291) << samples;
    }
  }
}

TEST(FirstOrderIndexInterval, CoversTheSkewed) {
  for (const std::size_t samples : {256U, 1024U}) {
    for (const double size : {0.5, 1.0}) {
      for (const Coverage& coverage :
           index_coverage(test::exponential(size, {.7, .25, .05}), samples, kRepetitions, 96 + samples)) {
        EXPECT_GE(coverage.z(), -3.090) << samples << ' ' << size;
      }
    }
  }
}

TEST(FirstOrderIndexInterval, CoversTheAggregated) {
  EXPECT_LE(std::abs(aggregated_coverage(Dependence::independent, 512, kRepetitions, 97).z()), 3.291);
  EXPECT_GE(aggregated_coverage(Dependence::unknown, 512, kRepetitions, 98).z(), -3.090);
}

TEST(EffectCurve, HoldsTheMeansOfBins) {
  // 32 bins of each repetition are as good as independent.
  for (const std::size_t samples : {512U, 4096U}) {
    for (const Coverage& coverage : curve_coverage(test::linear({.8, .2}), samples, kRepetitions, 99)) {
      EXPECT_LE(std::abs(coverage.z()), 3.291) << samples;
    }
  }
  EXPECT_NEAR(curve_coverage(test::folded(), 256, kRepetitions, 100)[1].share(), 0.928, 0.01);  // as stated
}

TEST(YieldGradientInterval, CoversWithNineRejectsOrMore) {
  EXPECT_GE(gradient_coverage(0.45, 1000, kRepetitions, 101).share(), 0.93);
  EXPECT_GE(gradient_coverage(0.3, 1000, kRepetitions, 102).share(), 0.935);
  EXPECT_GE(gradient_coverage(0.1, 1000, kRepetitions, 103).share(), 0.935);
  EXPECT_NEAR(gradient_coverage(0.3, 5000, kRepetitions, 104).share(), kLevel, 0.01);
}

/// The tables of THEORY.md: --gtest_also_run_disabled_tests --gtest_filter=*WideTable*
TEST(FirstOrderIndexInterval, DISABLED_WideTable) {
  const std::vector<EffectFunction> functions{test::linear({.8, .15, .05, 0.0}),
                                              test::linear({.99, .01}),
                                              test::linear({1.0}),
                                              test::ishigami(),
                                              test::folded(),
                                              test::exponential(.5, {.7, .25, .05}),
                                              test::exponential(1.0, {.7, .25, .05})};
  for (const EffectFunction& function : functions) {
    for (const std::size_t samples : {256U, 1024U, 4096U, 16384U}) {
      const auto indices = index_coverage(function, samples, 10000, 200 + samples);
      const auto curves = curve_coverage(function, samples, 1000, 300 + samples);
      for (std::size_t p = 0; p < indices.size(); ++p) {
        std::printf("%-10s n = %5zu  S1 = %.4f: index %.1f %% (above %.1f, below %.1f), curve %.1f %%\n",
                    function.name.c_str(), samples, function.first_order[p], 100.0 * indices[p].share(),
                    100.0 * indices[p].too_high(), 100.0 * indices[p].too_low(), 100.0 * curves[p].share());
      }
    }
  }
  for (const std::size_t samples : {256U, 1024U, 4096U, 16384U}) {
    std::printf("four poses n = %5zu: independent %.1f %%, the same machines %.1f %%\n", samples,
                100.0 * aggregated_coverage(Dependence::independent, samples, 10000, 400).share(),
                100.0 * aggregated_coverage(Dependence::unknown, samples, 10000, 500).share());
  }
}

TEST(YieldGradientInterval, DISABLED_WideTable) {
  for (const double limit : {0.45, 0.35, 0.3, 0.1}) {
    for (const std::size_t machines : {500U, 1000U, 2000U, 5000U, 20000U}) {
      const double good = std::erf(limit / std::sqrt(0.06));
      std::printf("yield %.4f, %5zu machines, %6.1f rejects: %.1f %%\n", good, machines,
                  (1.0 - good) * static_cast<double>(machines),
                  100.0 * gradient_coverage(limit, machines, 4000, 600).share());
    }
  }
}

}  // namespace
}  // namespace poesy
