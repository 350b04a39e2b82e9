#include "engine/random/stream.h"

#include <Random123/philox.h>

#include <algorithm>
#include <array>
#include <bit>

#include "engine/base/instruction_sets.h"
#include "engine/random/philox_vectors.h"

namespace poesy {

namespace {

constexpr std::uint64_t kBlockWords = 4;

r123::Philox4x64::ctr_type block_at(const StreamAddress& address, std::uint64_t block) {
  const r123::Philox4x64::ctr_type counter{{address.factor.value, address.pose.value, block, 0}};
  const r123::Philox4x64::key_type key{{address.seed, static_cast<std::uint64_t>(address.purpose)}};
  return r123::Philox4x64{}(counter, key);
}

/// As uniform_from_bits, which it defines.
[[gnu::always_inline]] inline double middle_of_cell(std::uint64_t bits) {
  // The cell, an integer below 2^53, in two parts of 32 and 21 bits: each is made the low bits of a power of two that
  // has room for it. Unlike a conversion this is vectorised on every instruction set, and it is as exact.
  const std::uint64_t cell = bits >> 11;
  const std::uint64_t low = cell & 0xffffffff;
  const std::uint64_t high = cell >> 32;
  const double sum = (std::bit_cast<double>(high | std::bit_cast<std::uint64_t>(0x1p84)) - 0x1p84) +
                     (std::bit_cast<double>(low | std::bit_cast<std::uint64_t>(0x1p52)) - 0x1p52);
  // The middle of the last cell is no double and would round to 1.
  return std::min((sum + 0.5) * 0x1p-53, 1.0 - 0x1p-53);
}

POESY_EACH_INSTRUCTION_SET void middles_of_cells(const std::uint64_t* bits, std::size_t count, double* uniforms) {
  for (std::size_t k = 0; k < count; ++k) uniforms[k] = middle_of_cell(bits[k]);
}

}  // namespace

std::uint64_t random_bits(const StreamAddress& address, SampleIndex sample) {
  return block_at(address, sample.value / kBlockWords)[sample.value % kBlockWords];
}

void fill_uniforms(const StreamAddress& address, SampleIndex first, std::span<double> uniforms) {
  // Whole blocks, of which the first may begin before the first sample and the last go on beyond the last one.
  constexpr std::size_t kWords = 512;
  const PhiloxRun run{
      address.factor.value, address.pose.value, {address.seed, static_cast<std::uint64_t>(address.purpose)}};
  std::array<std::uint64_t, kWords> words;
  std::uint64_t block = first.value / kBlockWords;
  std::size_t skipped = first.value % kBlockWords;
  while (!uniforms.empty()) {
    const std::size_t count = std::min(kWords - skipped, uniforms.size());
    const std::size_t blocks = (skipped + count + kBlockWords - 1) / kBlockWords;
    for (std::size_t n = philox_by_vectors(run, block, blocks, words.data()); n < blocks; ++n) {
      const auto four = block_at(address, block + n);
      std::copy_n(four.begin(), kBlockWords, words.data() + n * kBlockWords);
    }
    block += blocks;
    middles_of_cells(words.data() + skipped, count, uniforms.data());
    uniforms = uniforms.subspan(count);
    skipped = 0;
  }
}

double uniform_from_bits(std::uint64_t bits) { return middle_of_cell(bits); }

}  // namespace poesy
