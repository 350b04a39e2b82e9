#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "engine/random/stream.h"

namespace poesy {
namespace {

const StreamAddress kAddress{
    .seed = 42, .purpose = Purpose::error_samples, .factor = FactorIndex(5), .pose = PoseIndex(11)};

std::vector<double> uniforms(const StreamAddress& address, std::size_t first, std::size_t count) {
  std::vector<double> draws(count);
  fill_uniforms(address, SampleIndex(first), draws);
  return draws;
}

TEST(RandomBits, DiffersWhereAnyComponentDiffers) {
  std::set<std::uint64_t> draws;
  std::size_t addresses = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    for (const Purpose purpose : {Purpose::error_samples, Purpose::sampling_design}) {
      for (std::size_t factor = 0; factor < 8; ++factor) {
        for (std::size_t pose = 0; pose < 8; ++pose) {
          for (std::size_t sample = 0; sample < 16; ++sample) {
            draws.insert(random_bits({seed, purpose, FactorIndex(factor), PoseIndex(pose)}, SampleIndex(sample)));
            ++addresses;
          }
        }
      }
    }
  }
  // The probability that two of 8192 random 64-bit words are equal is 2e-12.
  EXPECT_EQ(draws.size(), addresses);
}

TEST(RandomBits, DoesNotDependOnTheOrderOfCalls) {
  std::vector<std::uint64_t> forward(50);
  std::vector<std::uint64_t> backward(50);
  for (std::size_t k = 0; k < 50; ++k) forward[k] = random_bits(kAddress, SampleIndex(k));
  for (std::size_t k = 50; k-- > 0;) backward[k] = random_bits(kAddress, SampleIndex(k));
  EXPECT_EQ(forward, backward);
}

TEST(FillUniforms, EqualsTheSingleDrawsFromAnyStart) {
  for (std::size_t first = 0; first < 9; ++first) {
    for (std::size_t count = 0; count < 14; ++count) {
      const std::vector<double> draws = uniforms(kAddress, first, count);
      for (std::size_t k = 0; k < count; ++k) {
        EXPECT_EQ(draws[k], uniform_from_bits(random_bits(kAddress, SampleIndex(first + k))))
            << "first " << first << ", draw " << k << " of " << count;
      }
    }
  }
}

TEST(FillUniforms, ManyDrawsEqualTheSingleOnes) {
  // Streams that are long enough for every code path, at addresses that use all 64 bits.
  const StreamAddress wide{.seed = 0xfedcba9876543210,
                           .purpose = Purpose::sampling_design,
                           .factor = FactorIndex(0xffffffffffffffff),
                           .pose = PoseIndex(0x123456789abcdef0)};
  for (const StreamAddress& address : {kAddress, wide}) {
    for (const std::size_t first : {std::size_t{0}, std::size_t{3}, std::size_t{0xfffffffffffe}}) {
      const std::vector<double> draws = uniforms(address, first, 3001);
      for (std::size_t k = 0; k < draws.size(); ++k) {
        ASSERT_EQ(draws[k], uniform_from_bits(random_bits(address, SampleIndex(first + k))))
            << "first " << first << ", draw " << k;
      }
    }
  }
}

TEST(FillUniforms, FewerDrawsAreThePrefixOfMore) {
  const std::vector<double> more = uniforms(kAddress, 0, 2000);
  for (const std::size_t count : {std::size_t{1}, std::size_t{999}, std::size_t{1000}, std::size_t{1998}}) {
    const std::vector<double> fewer = uniforms(kAddress, 0, count);
    EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), more.begin())) << count;
  }
}

TEST(FillUniforms, PiecesMakeTheWhole) {
  const std::vector<double> whole = uniforms(kAddress, 0, 1001);
  std::vector<double> joined = uniforms(kAddress, 0, 333);
  for (const double draw : uniforms(kAddress, 333, 668)) joined.push_back(draw);
  EXPECT_EQ(joined, whole);
}

}  // namespace
}  // namespace poesy
