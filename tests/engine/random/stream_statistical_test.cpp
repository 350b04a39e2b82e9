#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <vector>

#include "engine/random/stream.h"

// The seeds are fixed. Each check fails for a truly random stream with probability alpha = 0.001. The checks are
// two-sided: a stream that is too uniform fails like one that is too uneven.

namespace poesy {
namespace {

constexpr double kAlpha = 0.001;

StreamAddress address_of(std::size_t factor, std::size_t pose) {
  return {.seed = 1, .purpose = Purpose::error_samples, .factor = FactorIndex(factor), .pose = PoseIndex(pose)};
}

std::vector<double> uniforms(const StreamAddress& address, std::size_t count, std::size_t first = 0) {
  std::vector<double> draws(count);
  fill_uniforms(address, SampleIndex(first), draws);
  return draws;
}

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

/// Counts the pairs (a_k, b_k) in a grid of equal cells of the unit square. The counts are uneven if the two streams
/// depend on each other.
void expect_independent(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr std::size_t kCells = 32;
  std::vector<double> counts(kCells * kCells, 0.0);
  for (std::size_t k = 0; k < a.size(); ++k) {
    const auto row = static_cast<std::size_t>(a[k] * kCells);
    const auto column = static_cast<std::size_t>(b[k] * kCells);
    counts[row * kCells + column] += 1.0;
  }
  expect_even(counts);
}

TEST(Stream, IsUniformByChiSquare) {
  std::vector<double> counts(1000, 0.0);
  for (const double u : uniforms(address_of(0, 0), 1000000)) counts[static_cast<std::size_t>(u * 1000.0)] += 1.0;
  expect_even(counts);
}

TEST(Stream, IsUniformByKolmogorovAndSmirnov) {
  constexpr std::size_t kUniforms = 1000000;
  std::vector<double> draws = uniforms(address_of(24, 157), kUniforms);
  std::sort(draws.begin(), draws.end());
  double distance = 0.0;
  for (std::size_t k = 0; k < kUniforms; ++k) {
    const double below = static_cast<double>(k) / kUniforms;
    const double above = static_cast<double>(k + 1) / kUniforms;
    distance = std::max({distance, draws[k] - below, above - draws[k]});
  }
  // The quantiles of Kolmogorov's distribution for 0.0005 and 0.9995 are 0.3471 / sqrt(n) and 2.0368 / sqrt(n).
  EXPECT_GT(distance, 0.3471 / std::sqrt(kUniforms));
  EXPECT_LT(distance, 2.0368 / std::sqrt(kUniforms));
}

TEST(Stream, FirstDrawsOverAllAddressesAreUniform) {
  std::vector<double> counts(256, 0.0);
  for (std::size_t factor = 0; factor < 71; ++factor) {
    for (std::size_t pose = 0; pose < 1580; ++pose) {
      counts[random_bits(address_of(factor, pose), SampleIndex(0)) >> 56] += 1.0;
    }
  }
  expect_even(counts);
}

TEST(Stream, EachBitIsSetHalfTheTime) {
  constexpr int kBlocks = 100000;
  std::vector<int> set(64, 0);
  for (std::size_t k = 0; k < kBlocks; ++k) {
    const std::uint64_t bits = random_bits(address_of(7, 9), SampleIndex(k));
    for (std::size_t b = 0; b < 64; ++b) set[b] += static_cast<int>(bits >> b & 1);
  }
  // alpha = 0.001 divided by 64 bits (Bonferroni) gives z = 4.32.
  for (const int count : set) EXPECT_LE(std::abs(count - kBlocks / 2), 4.32 * 0.5 * std::sqrt(kBlocks));
}

TEST(Stream, NeighbourFactorsAreIndependent) {
  expect_independent(uniforms(address_of(5, 7), 200000), uniforms(address_of(6, 7), 200000));
}

TEST(Stream, NeighbourPosesAreIndependent) {
  expect_independent(uniforms(address_of(5, 7), 200000), uniforms(address_of(5, 8), 200000));
}

TEST(Stream, FactorAndPoseExchangedAreIndependent) {
  expect_independent(uniforms(address_of(5, 7), 200000), uniforms(address_of(7, 5), 200000));
}

TEST(Stream, NeighbourSamplesAreIndependent) {
  for (const std::size_t lag : {std::size_t{1}, std::size_t{4}}) {
    expect_independent(uniforms(address_of(5, 7), 200000), uniforms(address_of(5, 7), 200000, lag));
  }
}

TEST(Stream, NeighbourSeedsAreIndependent) {
  StreamAddress next = address_of(5, 7);
  next.seed = 2;
  expect_independent(uniforms(address_of(5, 7), 200000), uniforms(next, 200000));
}

TEST(Stream, PurposesAreIndependent) {
  StreamAddress design = address_of(5, 7);
  design.purpose = Purpose::sampling_design;
  expect_independent(uniforms(address_of(5, 7), 200000), uniforms(design, 200000));
}

}  // namespace
}  // namespace poesy
