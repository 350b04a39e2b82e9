#include "engine/random/stream.h"

#include <Random123/philox.h>

#include <algorithm>

namespace poesy {

namespace {

constexpr std::uint64_t kBlockWords = 4;

r123::Philox4x64::ctr_type block_at(const StreamAddress& address, std::uint64_t block) {
  const r123::Philox4x64::ctr_type counter{{address.factor.value, address.pose.value, block, 0}};
  const r123::Philox4x64::key_type key{{address.seed, static_cast<std::uint64_t>(address.purpose)}};
  return r123::Philox4x64{}(counter, key);
}

}  // namespace

std::uint64_t random_bits(const StreamAddress& address, SampleIndex sample) {
  return block_at(address, sample.value / kBlockWords)[sample.value % kBlockWords];
}

void fill_uniforms(const StreamAddress& address, SampleIndex first, std::span<double> uniforms) {
  std::uint64_t sample = first.value;
  for (std::size_t k = 0; k < uniforms.size();) {
    const auto block = block_at(address, sample / kBlockWords);
    for (std::size_t word = sample % kBlockWords; word < kBlockWords && k < uniforms.size(); ++word) {
      uniforms[k++] = uniform_from_bits(block[word]);
      ++sample;
    }
  }
}

double uniform_from_bits(std::uint64_t bits) {
  // Through a signed integer, which converts to double in one instruction; 53 bits always fit.
  const auto cell = static_cast<double>(static_cast<std::int64_t>(bits >> 11));
  // The middle of the last cell is no double and would round to 1.
  return std::min((cell + 0.5) * 0x1p-53, 1.0 - 0x1p-53);
}

}  // namespace poesy
