#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/random/distribution.h"
#include "engine/random/stream.h"
#include "engine/stats/moments.h"

// The seeds are fixed. Each check fails for a correct program with probability alpha = 0.001 (|z| > 3.291).

namespace poesy {
namespace {

constexpr double kZ = 3.291;

/// Expects that a million draws have the mean and the standard deviation of the distribution.
void expect_stated_moments(const Distribution& distribution) {
  constexpr std::size_t kDraws = 1000000;
  std::vector<double> draws(kDraws);
  fill_uniforms({.seed = 2022, .factor = FactorIndex(3), .pose = PoseIndex(4)}, SampleIndex(0), draws);
  distribution.transform(draws);
  Moments moments;
  for (const double draw : draws) moments.add(draw);

  const double sd = distribution.standard_deviation();
  EXPECT_LE(std::abs(moments.mean()), kZ * sd / std::sqrt(kDraws));
  // The deviation's standard error is sd sqrt((kurtosis - 1) / (4 n)).
  const double error = sd * std::sqrt((moments.kurtosis() - 1.0) / (4.0 * kDraws));
  EXPECT_LE(std::abs(moments.standard_deviation() - sd), kZ * error);
}

TEST(SampleMoments, OfTheNormal) { expect_stated_moments(Distribution::normal(1e-3)); }

TEST(SampleMoments, OfTheNarrowTruncatedNormal) { expect_stated_moments(Distribution::truncated_normal(1.0, 0.05)); }

TEST(SampleMoments, OfTheTruncatedNormal) { expect_stated_moments(Distribution::truncated_normal(1.0, 1.5)); }

TEST(SampleMoments, OfTheWideTruncatedNormal) { expect_stated_moments(Distribution::truncated_normal(1.0, 3.0)); }

TEST(SampleMoments, OfTheUniform) { expect_stated_moments(Distribution::uniform(2.0)); }

TEST(SampleMoments, OfAShiftedNormal) { expect_stated_moments(Distribution::normal(1.0).shifted(0.4)); }

TEST(SampleMoments, OfAShiftedUniform) { expect_stated_moments(Distribution::uniform(2.0).shifted(0.1)); }

TEST(SampleMoments, OfTheTriangular) { expect_stated_moments(Distribution::triangular(2.0)); }

}  // namespace
}  // namespace poesy
