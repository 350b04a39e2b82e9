#include "tests/engine/stats/effect_coverage.h"

#include <gtest/gtest.h>

#include <cmath>

namespace poesy {
namespace {

using test::aggregated_coverage;
using test::Coverage;
using test::curve_coverage;
using test::gradient_coverage;
using test::index_coverage;

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
  // The 32 bins of a repetition count as independent.
  for (const std::size_t samples : {512U, 4096U}) {
    for (const Coverage& coverage : curve_coverage(test::linear({.8, .2}), samples, kRepetitions, 99)) {
      EXPECT_LE(std::abs(coverage.z()), 3.291) << samples;
    }
  }
  EXPECT_NEAR(curve_coverage(test::folded(), 256, kRepetitions, 100)[1].share(), 0.928, 0.01);  // the stated coverage
}

TEST(YieldGradientInterval, CoversWithNineRejectsOrMore) {
  const auto share = [](double limit, std::size_t machines, std::uint64_t seed) {
    return gradient_coverage(test::normal_case(test::kThreeErrors, limit), machines, kRepetitions, seed).share();
  };
  EXPECT_GE(share(0.45, 1000, 101), 0.93);
  EXPECT_GE(share(0.3, 1000, 102), 0.935);
  EXPECT_GE(share(0.1, 1000, 103), 0.935);
  EXPECT_NEAR(share(0.3, 5000, 104), 0.95, 0.01);
}

TEST(YieldGradientInterval, OfOtherErrorsCovers) {
  const auto share = [](const test::YieldCase& yield, std::size_t machines, std::uint64_t seed) {
    return gradient_coverage(yield, machines, kRepetitions, seed).share();
  };
  const auto uniform = [](double limit) { return test::uniform_case(test::kThreeErrors, limit); };
  EXPECT_GE(share(uniform(0.4), 1000, 105), 0.935);
  EXPECT_GE(share(uniform(0.35), 250, 106), 0.935);
  EXPECT_GE(share(uniform(0.3), 1000, 107), 0.935);
  EXPECT_NEAR(share(uniform(0.3), 5000, 108), 0.95, 0.01);
  EXPECT_GE(share(test::correlated_case(0.1, 0.6, 0.7), 1000, 112), 0.93);
  const auto triangular = [](double limit) { return test::triangular_case(test::kThreeErrors, limit); };
  EXPECT_GE(share(triangular(0.4), 500, 109), 0.93);
  EXPECT_GE(share(triangular(0.3), 500, 110), 0.91);
  EXPECT_NEAR(share(triangular(0.3), 5000, 111), 0.95, 0.01);
}

}  // namespace
}  // namespace poesy
