#include "engine/random/philox_vectors.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

namespace poesy {

#if defined(__x86_64__) && defined(__GNUC__)

// Only AVX-512 has the lanes to beat one multiplication of 64 bits a cycle: the product of 64 bits by 64 takes four of
// 32 bits. Compilers do not find this form in plain loops.
#define POESY_AVX512 __attribute__((target("avx512f")))

namespace {

constexpr std::size_t kLanes = 8;
constexpr std::size_t kVectors = 2;  ///< independent of each other, so that one works while the other waits
constexpr std::size_t kGroup = kLanes * kVectors;
constexpr int kRounds = 10;
constexpr std::array<std::uint64_t, 2> kMultipliers{0xD2E7470EE14C6C93, 0xCA5A826395121157};
constexpr std::array<std::uint64_t, 2> kKeySteps{0x9E3779B97F4A7C15, 0xBB67AE8584CAA73B};

struct Product {
  __m512i high, low;
};

struct Blocks {
  __m512i c0, c1, c2, c3;
};

POESY_AVX512 inline __m512i everywhere(std::uint64_t value) { return _mm512_set1_epi64(static_cast<long long>(value)); }

/// By halves of 32 bits. No sum exceeds 64 bits: (2^32 - 1)^2 + 2 (2^32 - 1) = 2^64 - 1.
POESY_AVX512 inline Product multiply(__m512i a, std::uint64_t multiplier) {
  const __m512i b_low = everywhere(multiplier & 0xffffffff);
  const __m512i b_high = everywhere(multiplier >> 32);
  const __m512i a_high = _mm512_srli_epi64(a, 32);
  const __m512i low = _mm512_mul_epu32(a, b_low);
  const __m512i middle = _mm512_add_epi64(_mm512_mul_epu32(a_high, b_low), _mm512_srli_epi64(low, 32));
  const __m512i cross = _mm512_add_epi64(_mm512_mul_epu32(a, b_high), _mm512_and_si512(middle, everywhere(0xffffffff)));
  const __m512i high = _mm512_add_epi64(_mm512_mul_epu32(a_high, b_high), _mm512_srli_epi64(middle, 32));
  return {_mm512_add_epi64(high, _mm512_srli_epi64(cross, 32)),
          _mm512_mask_mov_epi32(_mm512_slli_epi64(cross, 32), 0x5555, low)};
}

POESY_AVX512 inline __m512i exclusive_or(__m512i a, __m512i b, __m512i c) {
  return _mm512_ternarylogic_epi64(a, b, c, 0x96);
}

POESY_AVX512 inline Blocks next_round(const Blocks& blocks, const std::array<std::uint64_t, 2>& key) {
  const Product first = multiply(blocks.c0, kMultipliers[0]);
  const Product second = multiply(blocks.c2, kMultipliers[1]);
  return {exclusive_or(second.high, blocks.c1, everywhere(key[0])), second.low,
          exclusive_or(first.high, blocks.c3, everywhere(key[1])), first.low};
}

/// Lane n of the four vectors becomes words 4 n to 4 n + 3.
POESY_AVX512 inline void store(const Blocks& blocks, std::uint64_t* words) {
  const __m512i even_01 = _mm512_unpacklo_epi64(blocks.c0, blocks.c1);  // of lanes 0, 2, 4, 6
  const __m512i odd_01 = _mm512_unpackhi_epi64(blocks.c0, blocks.c1);
  const __m512i even_23 = _mm512_unpacklo_epi64(blocks.c2, blocks.c3);
  const __m512i odd_23 = _mm512_unpackhi_epi64(blocks.c2, blocks.c3);
  // Pairs of words, of two lanes each: 0x44 takes lanes 0 and 2 of the evens or 1 and 3 of the odds, 0xee those after.
  const __m512i even_low = _mm512_shuffle_i64x2(even_01, even_23, 0x44);
  const __m512i odd_low = _mm512_shuffle_i64x2(odd_01, odd_23, 0x44);
  const __m512i even_high = _mm512_shuffle_i64x2(even_01, even_23, 0xee);
  const __m512i odd_high = _mm512_shuffle_i64x2(odd_01, odd_23, 0xee);
  _mm512_storeu_si512(words, _mm512_shuffle_i64x2(even_low, odd_low, 0x88));
  _mm512_storeu_si512(words + 8, _mm512_shuffle_i64x2(even_low, odd_low, 0xdd));
  _mm512_storeu_si512(words + 16, _mm512_shuffle_i64x2(even_high, odd_high, 0x88));
  _mm512_storeu_si512(words + 24, _mm512_shuffle_i64x2(even_high, odd_high, 0xdd));
}

POESY_AVX512 void write_group(const PhiloxRun& run, std::uint64_t first, std::uint64_t* words) {
  const __m512i lanes = _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7);
  std::array<Blocks, kVectors> blocks;
  for (std::size_t v = 0; v < kVectors; ++v) {
    blocks[v] = {everywhere(run.c0), everywhere(run.c1), _mm512_add_epi64(everywhere(first + v * kLanes), lanes),
                 _mm512_setzero_si512()};
  }
  std::array<std::uint64_t, 2> key = run.key;
  for (int round = 0; round < kRounds; ++round) {
    for (Blocks& eight : blocks) eight = next_round(eight, key);
    for (std::size_t k = 0; k < key.size(); ++k) key[k] += kKeySteps[k];
  }
  for (std::size_t v = 0; v < kVectors; ++v) store(blocks[v], words + 4 * v * kLanes);
}

}  // namespace

std::size_t philox_by_vectors(const PhiloxRun& run, std::uint64_t first, std::size_t count, std::uint64_t* words) {
  static const bool available = __builtin_cpu_supports("avx512f") != 0;
  if (!available) return 0;
  std::size_t written = 0;
  for (; written + kGroup <= count; written += kGroup) write_group(run, first + written, words + 4 * written);
  return written;
}

#undef POESY_AVX512

#else

std::size_t philox_by_vectors(const PhiloxRun&, std::uint64_t, std::size_t, std::uint64_t*) { return 0; }

#endif

}  // namespace poesy
