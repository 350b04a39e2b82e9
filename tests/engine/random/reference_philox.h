#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace poesy::test {

/// The high and the low word of the 128-bit product of two 64-bit words.
inline std::pair<std::uint64_t, std::uint64_t> full_product(std::uint64_t a, std::uint64_t b) {
  __extension__ using Wide = unsigned __int128;
  const Wide product = static_cast<Wide>(a) * b;
  return {static_cast<std::uint64_t>(product >> 64), static_cast<std::uint64_t>(product)};
}

/// Philox4x64-10 written from Salmon et al. 2011 (Sec. 3.3 and Table 2), independent of the Random123 library.
inline std::array<std::uint64_t, 4> reference_philox(std::array<std::uint64_t, 4> x, std::array<std::uint64_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const auto [high0, low0] = full_product(0xD2E7470EE14C6C93, x[0]);
    const auto [high1, low1] = full_product(0xCA5A826395121157, x[2]);
    x = {high1 ^ x[1] ^ key[0], low1, high0 ^ x[3] ^ key[1], low0};
    key[0] += 0x9E3779B97F4A7C15;  // golden ratio
    key[1] += 0xBB67AE8584CAA73B;  // sqrt(3) - 1
  }
  return x;
}

}  // namespace poesy::test
