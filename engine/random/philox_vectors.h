#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace poesy {

/// Counters (c0, c1, block, 0) and key of Philox4x64-10; the block varies.
struct PhiloxRun {
  std::uint64_t c0;                  ///< first word of the counter
  std::uint64_t c1;                  ///< second word of the counter
  std::array<std::uint64_t, 2> key;  ///< seed and purpose
};

/// Writes the words of blocks first, first + 1, ..., four each, as many of `count` blocks as come in whole groups of
/// vectors: none where the machine has no vectors that are faster than its multiplication of 64 bits. Returns how many
/// blocks were written.
std::size_t philox_by_vectors(const PhiloxRun& run, std::uint64_t first, std::size_t count, std::uint64_t* words);

}  // namespace poesy
