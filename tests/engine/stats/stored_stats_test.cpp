#include <gtest/gtest.h>

#include <limits>

#include "engine/stats/moments.h"
#include "engine/stats/quantile_sketch.h"

namespace poesy {
namespace {

template <class Stats>
Bytes written(const Stats& stats) {
  ByteWriter to;
  stats.write(to);
  return to.take();
}

template <class Stats>
Stats read_back(const Bytes& bytes) {
  ByteReader from(bytes);
  Stats stats = Stats::read(from);
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
  sketch.add(std::array{-kMost, -kLeast, -0.0, 0.0, std::numeric_limits<double>::denorm_min(), kLeast, kMost});
  const QuantileSketch stored = read_back<QuantileSketch>(written(sketch));
  EXPECT_EQ(stored.count(), 7U);
  EXPECT_EQ(stored.min(), -kMost);
  EXPECT_EQ(stored.max(), kMost);
}

TEST(StoredSketch, RefusesEveryTruncation) {
  QuantileSketch sketch;
  sketch.add(numbers(100));
  const Bytes bytes = written(sketch);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THROW(read_back<QuantileSketch>(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length))),
                 BytesError)
        << length;
  }
}

TEST(StoredSketch, RefusesWhatNoStreamGives) {
  const auto bytes = [](auto... numbers_then) {
    ByteWriter to;
    (to.number(static_cast<std::uint64_t>(numbers_then)), ...);
    to.real(1.0);
    to.real(2.0);
    return to.take();
  };
  EXPECT_NO_THROW(read_back<QuantileSketch>(bytes(0, 2, 261888, 1, 1, 0)));
  EXPECT_THROW(read_back<QuantileSketch>(bytes(0, 2, 524031, 1, 1, 0)), BytesError);  // infinity
  EXPECT_THROW(read_back<QuantileSketch>(bytes(0, 1, 0, 1, 0)), BytesError);          // subnormal
  EXPECT_THROW(read_back<QuantileSketch>(bytes(0, 0, 0)), BytesError);                // a range of nothing
  constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();
  EXPECT_THROW(read_back<QuantileSketch>(bytes(0, 2, 261888, kMost, 1, 0)), BytesError);
  EXPECT_THROW(read_back<QuantileSketch>(bytes(0, 1, 261888, kMost, 1)), BytesError);
}

TEST(StoredBuckets, AreTakenAsTheNumbersThemselves) {
  constexpr double kTiny = std::numeric_limits<double>::denorm_min();
  constexpr double kMax = std::numeric_limits<double>::max();
  for (const std::vector<double>& values :
       {numbers(1000), std::vector<double>{}, std::vector<double>{0.0, -0.0, kTiny}, std::vector<double>{-1.5},
        std::vector<double>{0.0, kMax, -1e-300, kTiny, 3.0}, std::vector<double>{-kMax, kMax}}) {
    const BucketedValues buckets(values);
    QuantileSketch expected;
    expected.add(buckets);
    QuantileSketch found;
    const Bytes bytes = written(buckets);
    found.add(read_back<BucketedValues>(bytes));
    EXPECT_EQ(written(found), written(expected));
    for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 100) {
      EXPECT_THROW(read_back<BucketedValues>(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length))),
                   BytesError);
    }
  }
  EXPECT_LT(written(BucketedValues(numbers(1000))).size(), 2100U);
}

TEST(StoredBuckets, OfAnyOtherBytesDoNoHarm) {
  const Bytes sound = written(BucketedValues(numbers(50)));
  for (std::size_t at = 0; at < sound.size(); ++at) {
    for (const auto flip : {std::byte{1}, std::byte{0x80}, std::byte{0xff}}) {
      Bytes changed = sound;
      changed[at] ^= flip;
      try {
        QuantileSketch sketch;
        sketch.add(read_back<BucketedValues>(changed));
      } catch (const BytesError&) {
        continue;
      }
    }
  }
}

}  // namespace
}  // namespace poesy
