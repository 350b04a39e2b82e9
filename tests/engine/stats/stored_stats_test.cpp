#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "engine/stats/moments.h"
#include "engine/stats/quantile_sketch.h"
#include "tests/engine/stats/stored_bytes.h"

namespace poesy {
namespace {

using test::written;

template <class Stats>
Stats read_back(const Bytes& bytes) {
  ByteReader from(bytes);
  Stats stats = read_state<Stats>(from);
  from.expect_end();
  return stats;
}

std::vector<double> numbers(int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(1e-3 * (k % 7 - 3) * (k + 1));
  return values;
}

TEST(StoredMoments, GoOnWithTheSameBits) {
  const auto values = numbers(1000);
  const std::span all(values);
  Moments whole = Moments::of(all.first(700));
  Moments stored = read_back<Moments>(written(whole));
  for (Moments* moments : {&whole, &stored}) moments->merge(Moments::of(all.subspan(700)));
  EXPECT_EQ(written(stored), written(whole));
  EXPECT_EQ(stored.kurtosis(), whole.kurtosis());
}

TEST(StoredSketch, GoesOnWithTheSameBits) {
  const auto values = numbers(5000);
  const std::span all(values);
  for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{3000}}) {
    QuantileSketch whole;
    whole.add(all.first(first));
    QuantileSketch stored = read_back<QuantileSketch>(written(whole));
    for (QuantileSketch* sketch : {&whole, &stored}) sketch->add(all.subspan(first));
    EXPECT_EQ(written(stored), written(whole));
    for (const double q : {0.0, 0.01, 0.5, 0.99, 1.0}) EXPECT_EQ(stored.quantile(q), whole.quantile(q));
  }
}

TEST(StoredSketch, HoldsTheExtremes) {
  constexpr double kMost = std::numeric_limits<double>::max();
  constexpr double kLeast = std::numeric_limits<double>::min();
  QuantileSketch sketch;
  for (int times = 1; times <= 100; ++times) {
    sketch.add(std::array{-kMost, -kLeast, -0.0, 0.0, std::numeric_limits<double>::denorm_min(), kLeast, kMost});
    const QuantileSketch stored = read_back<QuantileSketch>(written(sketch));
    EXPECT_EQ(stored.count(), 7U * static_cast<unsigned>(times));
    EXPECT_EQ(stored.min(), -kMost);
    EXPECT_EQ(stored.max(), kMost);
    EXPECT_NEAR(stored.quantile(0.2), -kLeast, kLeast / 100.0);
  }
}

TEST(StoredSketch, RefusesEveryTruncation) {
  for (const int count : {100, 300}) {
    QuantileSketch sketch;
    sketch.add(numbers(count));
    const Bytes bytes = written(sketch);
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      EXPECT_THROW(read_back<QuantileSketch>(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length))),
                   BytesError)
          << length;
    }
  }
}

/// The stored bytes of a sketch of 300 numbers: the count, the extremes, then the whole numbers `counts`.
Bytes sketch_bytes(const std::array<double, 4>& extremes, const std::vector<std::uint64_t>& counts) {
  ByteWriter to;
  to.number(300);
  to.reals(extremes);
  for (const std::uint64_t number : counts) to.number(number);
  return to.take();
}

constexpr double kNone = std::numeric_limits<double>::infinity();

/// `before`, then a page of 64 counts of which only the first is not zero, then `after`.
std::vector<std::uint64_t> with_page(std::vector<std::uint64_t> before, std::uint64_t first_count,
                                     const std::vector<std::uint64_t>& after) {
  before.push_back(first_count);
  before.insert(before.end(), 63, 0);
  before.insert(before.end(), after.begin(), after.end());
  return before;
}

TEST(StoredSketch, RefusesWhatNoStreamGives) {
  const std::array range{1.0, 1.0, 1.0, kNone};
  // The whole numbers are the octave, the count of zeros, the number of pages above zero (1) with its position and
  // counts, and the number of pages below zero (0).
  const auto of_page = [&](std::uint64_t octave, std::uint64_t zeros, std::uint64_t at, std::uint64_t count) {
    return sketch_bytes(range, with_page({octave, zeros, 1, at}, count, {0}));
  };
  EXPECT_EQ(read_back<QuantileSketch>(of_page(979, 0, 0, 300)).quantile(0.5), 1.0);
  EXPECT_NO_THROW(read_back<QuantileSketch>(of_page(979, 1, 0, 299)));
  EXPECT_THROW(read_back<QuantileSketch>(of_page(979, 0, 0, 299)), BytesError);   // too few
  EXPECT_THROW(read_back<QuantileSketch>(of_page(979, 0, 0, 301)), BytesError);   // too many
  EXPECT_THROW(read_back<QuantileSketch>(of_page(979, 301, 0, 0)), BytesError);   // too many zeros
  EXPECT_THROW(read_back<QuantileSketch>(of_page(978, 0, 0, 300)), BytesError);   // finer than doubles
  EXPECT_THROW(read_back<QuantileSketch>(of_page(2048, 0, 0, 300)), BytesError);  // no valid octave
  EXPECT_THROW(read_back<QuantileSketch>(of_page(979, 0, 1, 300)), BytesError);   // beyond the largest number
  const auto of_range = [&](const std::array<double, 4>& extremes) {
    return sketch_bytes(extremes, with_page({2047, 0, 1, 0}, 300, {0}));
  };
  EXPECT_NO_THROW(read_back<QuantileSketch>(of_range({1.0, 1.0, 1.0, kNone})));
  EXPECT_THROW(read_back<QuantileSketch>(of_range({2.0, 1.0, 1.0, kNone})), BytesError);
  EXPECT_THROW(read_back<QuantileSketch>(of_range({-kNone, 1.0, 1.0, kNone})), BytesError);
  EXPECT_THROW(read_back<QuantileSketch>(of_range({1.0, 1.0, kNone, kNone})), BytesError);
  EXPECT_THROW(read_back<QuantileSketch>(of_range({1.0, 1.0, 1.0, 1.0})), BytesError);
  EXPECT_THROW(read_back<QuantileSketch>(of_range({-1.0, 1.0, 1e-310, 1.0})), BytesError);
  EXPECT_THROW(read_back<QuantileSketch>(of_range({-1.0, 1.0, 2.0, 1.0})), BytesError);
}

std::vector<double> with(std::vector<double> values, const std::vector<double>& others) {
  values.insert(values.end(), others.begin(), others.end());
  return values;
}

std::vector<double> shifted(double offset) {
  std::vector<double> values = numbers(1000);
  for (double& value : values) value += offset;
  return values;
}

TEST(StoredNumbers, AreTakenAsTheNumbersThemselves) {
  constexpr double kTiny = std::numeric_limits<double>::denorm_min();
  constexpr double kMax = std::numeric_limits<double>::max();
  for (const std::vector<double>& values :
       {numbers(1000), std::vector<double>{}, std::vector<double>{0.0, -0.0, kTiny}, std::vector<double>{-1.5},
        std::vector<double>{0.0, kMax, -1e-300, kTiny, 3.0}, std::vector<double>{-kMax, kMax}, shifted(1e9),
        with(numbers(300), {0.0, kMax, -1e-300, kTiny, 3.0}), with(shifted(-7.0), {kMax, -kMax})}) {
    const NumberBlock buckets(values);
    QuantileSketch expected;
    expected.add(buckets);
    QuantileSketch found;
    const Bytes bytes = written(buckets);
    found.add(read_back<NumberBlock>(bytes));
    EXPECT_EQ(written(found), written(expected));
    for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 100) {
      EXPECT_THROW(read_back<NumberBlock>(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length))),
                   BytesError);
    }
  }
  EXPECT_LT(written(NumberBlock(numbers(1000))).size(), 2100U);
}

TEST(StoredNumbers, OfAnyOtherBytesDoNoHarm) {
  for (const int count : {50, 300}) {
    const Bytes sound = written(NumberBlock(numbers(count)));
    for (std::size_t at = 0; at < sound.size(); ++at) {
      for (const auto flip : {std::byte{1}, std::byte{0x80}, std::byte{0xff}}) {
        Bytes changed = sound;
        changed[at] ^= flip;
        try {
          QuantileSketch sketch;
          sketch.add(read_back<NumberBlock>(changed));
        } catch (const BytesError&) {
          continue;
        }
      }
    }
  }
}

}  // namespace
}  // namespace poesy
