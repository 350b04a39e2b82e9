#include "engine/random/stream.h"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/engine/random/reference_philox.h"

namespace poesy {
namespace {

struct KnownAnswer {
  std::array<std::uint64_t, 4> counter;
  std::array<std::uint64_t, 2> key;
  std::array<std::uint64_t, 4> words;
};

constexpr std::uint64_t kOnes = ~std::uint64_t{0};

/// The known answers for "philox4x64 10" in the file kat_vectors of Random123.
const std::array<KnownAnswer, 3> kKnownAnswers{{
    {{0, 0, 0, 0}, {0, 0}, {0x16554d9eca36314c, 0xdb20fe9d672d0fdc, 0xd7e772cee186176b, 0x7e68b68aec7ba23b}},
    {{kOnes, kOnes, kOnes, kOnes},
     {kOnes, kOnes},
     {0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6, 0xa09caebf594f0ba0}},
    {{0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0, 0x082efa98ec4e6c89},
     {0x452821e638d01377, 0xbe5466cf34e90c6c},
     {0xa528f45403e61d95, 0x38c72dbd566e9788, 0xa5a1610e72fd18b5, 0x57bd43b5e52b7fe6}},
}};

TEST(Philox, LibraryGivesItsKnownAnswers) {
  for (const KnownAnswer& known : kKnownAnswers) {
    const r123::Philox4x64::ctr_type counter{{known.counter[0], known.counter[1], known.counter[2], known.counter[3]}};
    const auto words = r123::Philox4x64{}(counter, r123::Philox4x64::key_type{{known.key[0], known.key[1]}});
    for (std::size_t w = 0; w < 4; ++w) EXPECT_EQ(words[w], known.words[w]);
  }
}

TEST(Philox, ReferenceGivesTheKnownAnswers) {
  for (const KnownAnswer& known : kKnownAnswers) {
    EXPECT_EQ(test::reference_philox(known.counter, known.key), known.words);
  }
}

TEST(RandomBits, ZeroAddressGivesTheKnownAnswer) {
  const StreamAddress zero{.seed = 0, .purpose = Purpose{0}, .factor = FactorIndex(0), .pose = PoseIndex(0)};
  for (std::size_t w = 0; w < 4; ++w) EXPECT_EQ(random_bits(zero, SampleIndex(w)), kKnownAnswers[0].words[w]);
}

TEST(RandomBits, EveryComponentStandsWhereTheContractSays) {
  const StreamAddress address{.seed = 0x0123456789abcdef,
                              .purpose = Purpose::sampling_design,
                              .factor = FactorIndex(70),
                              .pose = PoseIndex(157)};
  for (const std::uint64_t sample : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{3},
                                     std::uint64_t{4}, std::uint64_t{999}, std::uint64_t{1} << 40, kOnes}) {
    const auto words = test::reference_philox({70, 157, sample / 4, 0}, {0x0123456789abcdef, 2});
    EXPECT_EQ(random_bits(address, SampleIndex(sample)), words[sample % 4]) << "sample " << sample;
  }
}

TEST(UniformFromBits, NamesTheMiddleOfItsCell) {
  EXPECT_EQ(uniform_from_bits(0), 0x1p-54);
  EXPECT_EQ(uniform_from_bits(0x7ff), 0x1p-54) << "the lower 11 bits do not matter";
  EXPECT_EQ(uniform_from_bits(0x800), 3 * 0x1p-54);
  EXPECT_EQ(uniform_from_bits(std::uint64_t{1} << 62), 0.25 + 0x1p-54);
  EXPECT_EQ(uniform_from_bits((std::uint64_t{1} << 63) - 1), 0.5 - 0x1p-54);
}

TEST(UniformFromBits, StaysBelowOne) {
  EXPECT_EQ(uniform_from_bits(kOnes), 1.0 - 0x1p-53);
  EXPECT_EQ(uniform_from_bits(kOnes << 11), 1.0 - 0x1p-53);
}

TEST(FillUniforms, FillsNothingIntoNothing) {
  std::vector<double> none;
  fill_uniforms({}, SampleIndex(3), none);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace poesy
