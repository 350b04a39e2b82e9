#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "engine/random/latin_hypercube.h"
#include "engine/random/scrambled_sobol.h"
#include "engine/random/stream.h"
#include "engine/stats/moments.h"

// The seeds are fixed. Each check fails for a correct design with probability alpha = 0.001. The checks are two-sided:
// counts that are too even fail like counts that are too uneven.

namespace poesy {
namespace {

constexpr double kAlpha = 0.001;
constexpr double kTwoSided = 3.291;  // z at alpha

void expect_even(const std::vector<double>& counts) {
  double total = 0.0;
  for (const double count : counts) total += count;
  const double expected = total / static_cast<double>(counts.size());
  double chi2 = 0.0;
  for (const double count : counts) chi2 += (count - expected) * (count - expected) / expected;
  const boost::math::chi_squared law(static_cast<double>(counts.size() - 1));
  EXPECT_GT(chi2, boost::math::quantile(law, 0.5 * kAlpha));
  EXPECT_LT(chi2, boost::math::quantile(boost::math::complement(law, 0.5 * kAlpha)));
}

double scrambled(const ScrambledSobol& points, std::size_t dimension, std::size_t replicate, std::size_t point) {
  double uniform = 0.0;
  points.fill({.dimension = dimension, .replicate = replicate}, SampleIndex(point), std::span(&uniform, 1));
  return uniform;
}

std::size_t cell(double uniform, std::size_t cells) {
  return static_cast<std::size_t>(uniform * static_cast<double>(cells));
}

TEST(ScrambledSobol, EveryPointIsUniformOverReplicates) {
  const ScrambledSobol points(40, 11);
  for (const std::size_t point : {0U, 1U, 77U}) {
    for (const std::size_t dimension : {0U, 39U}) {
      std::vector<double> counts(256, 0.0);
      for (std::size_t r = 0; r < 30000; ++r) counts[cell(scrambled(points, dimension, r, point), 256)] += 1.0;
      expect_even(counts);
    }
  }
}

TEST(ScrambledSobol, DeepDigitsAreUniformOverReplicates) {
  // The joint distribution of the binary digits 25 to 32 (then 33 to 40) and the first two digits of a coordinate.
  const ScrambledSobol points(3, 12);
  for (const double scale : {0x1p24, 0x1p32}) {
    std::vector<double> counts(1024, 0.0);
    for (std::size_t r = 0; r < 100000; ++r) {
      const double u = scrambled(points, 2, r, 5);
      const double deep = u * scale - std::floor(u * scale);
      counts[cell(deep, 256) * 4 + cell(u, 4)] += 1.0;
    }
    expect_even(counts);
  }
}

TEST(ScrambledSobol, DimensionsAreIndependentOverReplicates) {
  const ScrambledSobol points(2, 13);
  std::vector<double> counts(1024, 0.0);
  for (std::size_t r = 0; r < 50000; ++r) {
    counts[cell(scrambled(points, 0, r, 3), 32) * 32 + cell(scrambled(points, 1, r, 3), 32)] += 1.0;
  }
  expect_even(counts);
}

TEST(ScrambledSobol, DigitsBelowNodesThatPartAreIndependent) {
  // Points 0 and 1 share no leading digit; points 0 and 3 share the first. The next three digits after the first
  // different one are independent in both points, so all 64 pairs of them are equally likely. A digital shift instead
  // of a nested scramble would make them equal.
  const ScrambledSobol points(1, 14);
  for (const auto& [other, shared] : std::map<std::size_t, std::size_t>{{1, 0}, {3, 1}}) {
    std::vector<double> counts(64, 0.0);
    for (std::size_t r = 0; r < 30000; ++r) {
      const std::size_t all = std::size_t{1} << (shared + 4);
      const std::size_t one = cell(scrambled(points, 0, r, 0), all);
      const std::size_t two = cell(scrambled(points, 0, r, other), all);
      ASSERT_EQ(one >> 3 ^ two >> 3, 1U);
      counts[(one & 7) * 8 + (two & 7)] += 1.0;
    }
    expect_even(counts);
  }
}

TEST(LatinHypercube, PermutationsAreAllAsLikely) {
  for (const auto& [n, permutations] : std::map<std::size_t, std::size_t>{{3, 6}, {4, 24}, {5, 120}}) {
    const LatinHypercube design(n, 15);
    std::map<std::vector<std::size_t>, double> seen;
    std::vector<double> uniforms(n);
    for (std::size_t r = 0; r < 100 * permutations; ++r) {
      design.fill({.dimension = 1, .replicate = r}, SampleIndex(0), uniforms);
      std::vector<std::size_t> strata;
      for (const double u : uniforms) strata.push_back(cell(u, n));
      seen[strata] += 1.0;
    }
    std::vector<double> counts;
    for (const auto& [strata, count] : seen) counts.push_back(count);
    EXPECT_EQ(counts.size(), permutations);
    expect_even(counts);
  }
}

TEST(LatinHypercube, NeighboursAreIndependent) {
  // The strata of neighbouring samples k and k + 1 of a large design.
  const LatinHypercube design(100000, 16);
  std::vector<double> uniforms(100000);
  design.fill({.dimension = 3}, SampleIndex(0), uniforms);
  std::vector<double> counts(256, 0.0);
  for (std::size_t k = 0; k < uniforms.size(); k += 2) {
    counts[cell(uniforms[k], 16) * 16 + cell(uniforms[k + 1], 16)] += 1.0;
  }
  expect_even(counts);
}

TEST(LatinHypercube, DimensionsAreIndependent) {
  const LatinHypercube design(65536, 17);
  std::vector<double> x(65536);
  std::vector<double> y(65536);
  design.fill({.dimension = 0}, SampleIndex(0), x);
  design.fill({.dimension = 1}, SampleIndex(0), y);
  std::vector<double> counts(1024, 0.0);
  for (std::size_t k = 0; k < x.size(); ++k) counts[cell(x[k], 32) * 32 + cell(y[k], 32)] += 1.0;
  // Each row and each column has the same number of points, so 31 x 31 degrees of freedom are left.
  double chi2 = 0.0;
  for (const double count : counts) chi2 += (count - 64.0) * (count - 64.0) / 64.0;
  const boost::math::chi_squared law(31.0 * 31.0);
  EXPECT_GT(chi2, boost::math::quantile(law, 0.5 * kAlpha));
  EXPECT_LT(chi2, boost::math::quantile(boost::math::complement(law, 0.5 * kAlpha)));
}

TEST(LatinHypercube, PlacesInStrataAreUniform) {
  const LatinHypercube design(50000, 18);
  std::vector<double> uniforms(50000);
  design.fill({.dimension = 3}, SampleIndex(0), uniforms);
  std::vector<double> counts(100, 0.0);
  for (const double u : uniforms) counts[cell(u * 50000.0 - std::floor(u * 50000.0), 100)] += 1.0;
  expect_even(counts);
}

using Fill = std::function<void(std::size_t dimension, std::size_t replicate, std::span<double> uniforms)>;

/// Two functions of six uniforms with the mean 1: a product of exponentials (with interactions), and the mean of the
/// same exponentials (without).
enum class Terms { with_interactions, without };

/// The moments of 200 estimates of the function's mean, each from one replicate of 1024 points.
Moments means(const Fill& fill, Terms terms) {
  constexpr std::size_t kPoints = 1024;
  Moments means;
  std::vector<double> uniforms(kPoints);
  for (std::size_t r = 0; r < 200; ++r) {
    std::vector<double> values(kPoints, terms == Terms::without ? 0.0 : 1.0);
    for (std::size_t d = 0; d < 6; ++d) {
      fill(d, r, uniforms);
      for (std::size_t p = 0; p < kPoints; ++p) {
        const double factor = std::exp(uniforms[p]) / (std::numbers::e - 1.0);
        values[p] = terms == Terms::without ? values[p] + factor / 6.0 : values[p] * factor;
      }
    }
    means.add(Moments::of(values).mean());
  }
  return means;
}

Fill random_fill() {
  return [](std::size_t dimension, std::size_t replicate, std::span<double> uniforms) {
    const StreamAddress address{1, Purpose::sampling_design, FactorIndex(dimension), PoseIndex(replicate)};
    fill_uniforms(address, SampleIndex(0), uniforms);
  };
}

/// Expects that the estimates with a design are unbiased and that their variance is less than that of random points by
/// more than the factor `times`.
void expect_better(const Fill& fill, Terms terms, double times) {
  const Moments design = means(fill, terms);
  const Moments random = means(random_fill(), terms);
  EXPECT_NEAR(design.mean(), 1.0, kTwoSided * design.standard_deviation() / std::sqrt(200.0));
  testing::Test::RecordProperty("variance_over_random", std::to_string(design.variance() / random.variance()));
  EXPECT_LT(design.variance() * times, random.variance());
}

TEST(ScrambledSobol, MeansOfSmoothFunctionsAreSurer) {
  const ScrambledSobol points(6, 19);
  const Fill fill = [&](std::size_t dimension, std::size_t replicate, std::span<double> uniforms) {
    points.fill({.dimension = dimension, .replicate = replicate}, SampleIndex(0), uniforms);
  };
  expect_better(fill, Terms::with_interactions, 100.0);
  expect_better(fill, Terms::without, 1e4);
}

TEST(LatinHypercube, MeansOfSumsAreUnbiasedAndMuchSurer) {
  const LatinHypercube design(1024, 20);
  const Fill fill = [&](std::size_t dimension, std::size_t replicate, std::span<double> uniforms) {
    design.fill({.dimension = dimension, .replicate = replicate}, SampleIndex(0), uniforms);
  };
  expect_better(fill, Terms::without, 1e4);
}

}  // namespace
}  // namespace poesy
