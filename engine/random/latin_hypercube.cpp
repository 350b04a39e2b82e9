#include "engine/random/latin_hypercube.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/random/stream.h"

namespace poesy {

namespace {

constexpr std::size_t kRounds = 8;

/// The least number of bits of the Feistel network. With fewer bits, the permutations are not equally likely.
constexpr unsigned kFewestBits = 10;

/// A random permutation of the strata 0 .. n - 1. Each value is computed without the others, and none is stored.
class Permutation {
 public:
  Permutation(const StreamAddress& address, std::uint64_t strata)
      : strata_(strata), high_bits_(bits_for(strata) / 2), low_bits_(bits_for(strata) - high_bits_) {
    // The keys are the random bits of the blocks that follow those of the samples.
    constexpr std::uint64_t kKeyBlock = LatinHypercube::kMostSamples / 4;
    for (std::size_t k = 0; k < kRounds; k += 4) {
      std::ranges::copy(random_block(address, kKeyBlock + k / 4), keys_.begin() + k);
    }
  }

  std::uint64_t operator()(std::uint64_t stratum) const {
    do {
      stratum = shuffled(stratum);
    } while (stratum >= strata_);
    return stratum;
  }

 private:
  static unsigned bits_for(std::uint64_t strata) {
    return std::max(static_cast<unsigned>(std::bit_width(strata - 1)), kFewestBits);
  }

  /// The round function of the network, the finaliser of MurmurHash3 (Appleby 2011). half: one half of the bits of a
  /// number.
  static std::uint64_t hash(std::uint64_t key, std::uint64_t half) {
    std::uint64_t x = key + half * 0x9e3779b97f4a7c15;
    x = (x ^ x >> 33) * 0xff51afd7ed558ccd;
    x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53;
    return x ^ x >> 33;
  }

  /// The Feistel network, which permutes all numbers of high_bits_ + low_bits_ bits.
  std::uint64_t shuffled(std::uint64_t number) const {
    const std::uint64_t high_mask = (std::uint64_t{1} << high_bits_) - 1;
    const std::uint64_t low_mask = (std::uint64_t{1} << low_bits_) - 1;
    std::uint64_t high = number >> low_bits_;
    std::uint64_t low = number & low_mask;
    for (std::size_t round = 0; round < kRounds; round += 2) {
      low ^= hash(keys_[round], high) & low_mask;
      high ^= hash(keys_[round + 1], low) & high_mask;
    }
    return high << low_bits_ | low;
  }

  std::uint64_t strata_;
  unsigned high_bits_;
  unsigned low_bits_;
  std::array<std::uint64_t, kRounds> keys_{};
};

}  // namespace

LatinHypercube::LatinHypercube(std::uint64_t samples, std::uint64_t seed) : samples_(samples), seed_(seed) {
  POESY_EXPECTS(samples > 0 && samples <= kMostSamples);
}

void LatinHypercube::fill(const DesignColumn& column, SampleIndex first, std::span<double> uniforms) const {
  POESY_EXPECTS(first.value + uniforms.size() <= samples_);
  const StreamAddress address{.seed = seed_,
                              .purpose = Purpose::latin_hypercube,
                              .factor = FactorIndex(column.dimension),
                              .pose = PoseIndex(column.replicate)};
  const Permutation permutation(address, samples_);
  const auto n = static_cast<double>(samples_);
  fill_uniforms(address, first, uniforms);
  for (std::size_t k = 0; k < uniforms.size(); ++k) {
    const auto stratum = static_cast<double>(permutation(first.value + k));
    // A place near the end of its stratum would be rounded to the next stratum.
    const double place = std::min(stratum + uniforms[k], std::nextafter(stratum + 1.0, 0.0));
    uniforms[k] = place / n;
  }
}

}  // namespace poesy
