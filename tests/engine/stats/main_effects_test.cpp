#include "engine/stats/main_effects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <limits>

#include "engine/random/stream.h"
#include "tests/engine/stats/stored_bytes.h"

namespace poesy {
namespace {

using test::expect_no_harm;
using test::read_all;
using test::written;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Random samples of several responses to several errors. Some samples do not count. The responses are far from zero
/// and vary little.
struct Samples {
  std::size_t errors;
  std::size_t responses;
  std::size_t count;
  std::vector<double> uniforms;  ///< [errors x samples]
  std::vector<double> values;    ///< [responses x samples]
  std::vector<std::uint8_t> counts;

  Samples(std::size_t errors_count, std::size_t responses_count, std::size_t samples)
      : errors(errors_count),
        responses(responses_count),
        count(samples),
        uniforms(errors * count),
        values(responses * count),
        counts(count) {
    boost::random::mt19937_64 engine(5);
    for (double& uniform : uniforms) uniform = uniform_from_bits(engine());
    for (std::uint8_t& flag : counts) flag = static_cast<std::uint8_t>(engine() % 20 != 0);
    for (std::size_t r = 0; r < responses; ++r) {
      for (std::size_t b = 0; b < count; ++b) {
        const double effect = uniforms[r % errors * count + b] - 0.3 * uniforms[b];
        values[r * count + b] = counts[b] != 0 ? 1e3 * static_cast<double>(r + 1) + 1e-2 * effect : kNone;
      }
    }
  }

  Samples part(std::size_t first, std::size_t size) const {
    Samples some = *this;
    some.count = size;
    const auto cut = [&](const auto& all, auto& to, std::size_t rows) {
      to.clear();
      for (std::size_t k = 0; k < rows; ++k) {
        const auto row = all.begin() + static_cast<std::ptrdiff_t>(k * count + first);
        to.insert(to.end(), row, row + static_cast<std::ptrdiff_t>(size));
      }
    };
    cut(uniforms, some.uniforms, errors);
    cut(values, some.values, responses);
    cut(counts, some.counts, 1);
    return some;
  }

  void add_to(MainEffectSums& sums) const { sums.add(EffectBins(uniforms, errors), values, counts); }

  /// The counting samples of a response that lie in one bin of an error.
  std::vector<double> in_bin(std::size_t response, std::size_t error, std::size_t bin) const {
    std::vector<double> found;
    for (std::size_t b = 0; b < count; ++b) {
      if (counts[b] != 0 && std::floor(32.0 * uniforms[error * count + b]) == static_cast<double>(bin)) {
        found.push_back(values[response * count + b]);
      }
    }
    return found;
  }
};

MainEffectSums sums_of(const Samples& samples) {
  MainEffectSums sums(samples.errors, samples.responses);
  samples.add_to(sums);
  return sums;
}

/// The sums of the samples, cut into blocks of this size whose sums are merged.
MainEffectSums in_blocks(const Samples& samples, std::size_t size) {
  MainEffectSums sums(samples.errors, samples.responses);
  for (std::size_t first = 0; first < samples.count; first += size) {
    sums.merge(sums_of(samples.part(first, std::min(size, samples.count - first))));
  }
  return sums;
}

TEST(EffectBins, AreEqualPartsOfTheUniforms) {
  const double below_one = 1.0 - 0x1p-53;
  const EffectBins bins(std::array{0.0, 1.0 / 32.0, 0.5 - 0x1p-54, 0.5, 31.0 / 32.0, below_one}, 2);
  EXPECT_EQ(bins.errors(), 2U);
  EXPECT_EQ(bins.samples(), 3U);
  EXPECT_EQ(std::vector<std::uint8_t>(bins.bins().begin(), bins.bins().end()),
            (std::vector<std::uint8_t>{0, 1, 15, 16, 31, 31}));
  EXPECT_EQ(bins.filled()[0], 1U);
  EXPECT_EQ(bins.filled()[kEffectBins + 31], 2U);
}

TEST(MainEffectSums, AreThoseOfTheBins) {
  // Some of these numbers of errors and responses fill the SIMD vectors of the sums, others do not.
  for (const auto& [errors, responses] : {std::pair{1U, 1U}, {4U, 4U}, {6U, 5U}, {7U, 3U}}) {
    const Samples samples(errors, responses, 3001);
    const MainEffectSums sums = sums_of(samples);
    for (std::size_t r = 0; r < responses; ++r) {
      for (std::size_t p = 0; p < errors; ++p) {
        const auto curve = sums.curve(r, p, 0.95);
        for (std::size_t b = 0; b < kEffectBins; ++b) {
          const Moments expected = Moments::of(samples.in_bin(r, p, b));
          EXPECT_NEAR(curve[b].value, expected.mean(), 1e-12 * expected.mean());
          EXPECT_NEAR(curve[b].interval.low, mean_interval(expected, 0.95).low, 1e-12 * expected.mean());
          EXPECT_NEAR(curve[b].interval.high, mean_interval(expected, 0.95).high, 1e-12 * expected.mean());
        }
      }
    }
  }
}

TEST(MainEffectSums, CountTheSamplesThatCount) {
  const Samples samples(3, 2, 1000);
  EXPECT_EQ(sums_of(samples).samples(),
            static_cast<std::uint64_t>(std::ranges::count(samples.counts, std::uint8_t{1})));
}

TEST(MainEffectSums, DoNotDependOnBlocks) {
  const Samples samples(5, 6, 2000);
  const MainEffectSums whole = sums_of(samples);
  for (const std::size_t size : {1U, 37U, 1000U}) {
    const MainEffectSums blocks = in_blocks(samples, size);
    EXPECT_EQ(blocks.samples(), whole.samples());
    for (std::size_t r = 0; r < samples.responses; ++r) {
      for (std::size_t p = 0; p < samples.errors; ++p) {
        const BinnedVariance expected = whole.variance(r, p, {});
        const BinnedVariance found = blocks.variance(r, p, {});
        EXPECT_NEAR(found.between, expected.between, 1e-9 * expected.total);
        EXPECT_NEAR(found.total, expected.total, 1e-9 * expected.total);
        EXPECT_NEAR(found.noise[0], expected.noise[0], 1e-9 * expected.noise[0]);
      }
    }
    EXPECT_EQ(written(in_blocks(samples, size)), written(blocks));
  }
}

TEST(MainEffectSums, TakeBlocksInWhichNothingCounts) {
  Samples samples(2, 1, 100);
  const MainEffectSums before = sums_of(samples);
  MainEffectSums sums(2, 1);
  Samples nothing = samples;
  std::ranges::fill(nothing.counts, std::uint8_t{0});
  nothing.add_to(sums);
  EXPECT_EQ(sums.samples(), 0U);
  EXPECT_TRUE(std::isnan(sums.variance(0, 0, {}).between));
  EXPECT_TRUE(std::isnan(sums.curve(0, 0, 0.95)[3].value));
  samples.add_to(sums);
  EXPECT_EQ(written(sums), written(before));
  nothing.add_to(sums);
  sums.merge(MainEffectSums(2, 1));
  EXPECT_EQ(written(sums), written(before));
}

TEST(MainEffectSums, SayNothingOfABinWithTooFewSamples) {
  MainEffectSums sums(1, 1);
  sums.add(EffectBins(std::array{0.01, 0.04, 0.05}, 1), std::array{1.0, 2.0, 4.0},
           std::array<std::uint8_t, 3>{1, 1, 1});
  const auto curve = sums.curve(0, 0, 0.95);
  EXPECT_EQ(curve[0].value, 1.0);
  EXPECT_TRUE(std::isnan(curve[0].interval.low));
  EXPECT_EQ(curve[1].value, 3.0);
  EXPECT_NEAR(curve[1].interval.low, 3.0 - 12.7062047, 1e-6);  // Student's t with one degree of freedom
  EXPECT_TRUE(std::isnan(curve[2].value));
  EXPECT_TRUE(std::isnan(curve[2].interval.high));
}

TEST(StoredMainEffectSums, GoOnWithTheSameBits) {
  const Samples samples(3, 5, 900);
  const auto read = [](ByteReader& from) { return read_state<MainEffectSums>(from, 3, 5); };
  for (const MainEffectSums& begun : {MainEffectSums(3, 5), in_blocks(samples, 300)}) {
    MainEffectSums sums = begun;
    MainEffectSums stored = read_all(written(sums), read);
    for (MainEffectSums* each : {&sums, &stored}) samples.add_to(*each);
    EXPECT_EQ(written(stored), written(sums));
  }
  expect_no_harm(written(in_blocks(samples, 300)), read);
}

/// The stored state for one response and one error, with ten samples. first, second: numbers of samples in the first
/// two bins.
Bytes state(std::uint64_t first, std::uint64_t second, double square, double shift = 0.0) {
  MainEffectSums sums(1, 1);
  ByteWriter to;
  to.number(first);
  to.number(second);
  for (std::size_t b = 2; b < kEffectBins; ++b) to.number(0);
  write_state(Moments::of(std::array{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0}), to);
  to.real(shift);
  to.reals(std::array{4.0, square, 6.0, 6.0});
  to.reals(std::vector<double>(2 * (kEffectBins - 2)));
  return to.take();
}

TEST(StoredMainEffectSums, OfNoSamplesAreRefused) {
  const auto read = [](ByteReader& from) { return read_state<MainEffectSums>(from, 1, 1); };
  EXPECT_NO_THROW(read_all(state(4, 6, 4.0), read));
  EXPECT_THROW(read_all(state(4, 5, 4.0), read), BytesError);    // fewer in bins than in all
  EXPECT_THROW(read_all(state(10, 0, 4.0), read), BytesError);   // sums of no sample
  EXPECT_THROW(read_all(state(4, 6, 3.9), read), BytesError);    // squares below those of the mean
  EXPECT_THROW(read_all(state(4, 6, -4.0), read), BytesError);   // negative
  EXPECT_THROW(read_all(state(4, 6, kNone), read), BytesError);  // NaN
  EXPECT_THROW(read_all(state(4, 6, 4.0, kNone), read), BytesError);
}

}  // namespace
}  // namespace poesy
