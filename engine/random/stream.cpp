#include "engine/random/stream.h"

#include <Random123/philox.h>

#include <algorithm>
#include <array>
#include <bit>

#include "engine/base/instruction_sets.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

namespace poesy {

namespace {

constexpr std::uint64_t kBlockWords = 4;

/// The counter (c0, c1, block, 0) and the key of Philox4x64-10, for a run of consecutive blocks.
struct PhiloxRun {
  std::uint64_t c0;                  ///< first word of the counter
  std::uint64_t c1;                  ///< second word of the counter
  std::array<std::uint64_t, 2> key;  ///< seed and purpose
};

#if defined(__x86_64__) && defined(__GNUC__)

// Philox multiplies 64 bits by 64 bits. Vectors multiply only 32 bits by 32 bits, four times for one such product, so
// only AVX-512 has enough lanes to be faster than scalar code. Compilers do not vectorise this by themselves.
#define POESY_AVX512 __attribute__((target("avx512f")))

constexpr std::size_t kLanes = 8;
constexpr std::size_t kVectors = 2;  ///< independent vectors, so that the processor works on one while the other waits
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

/// The product of 64 by 64 bits in each lane, from products of 32-bit halves. No sum overflows 64 bits, because (2^32 -
/// 1)^2 + 2 (2^32 - 1) = 2^64 - 1.
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

/// Writes lane n of the four vectors to words 4 n to 4 n + 3.
POESY_AVX512 inline void store(const Blocks& blocks, std::uint64_t* words) {
  const __m512i even_01 = _mm512_unpacklo_epi64(blocks.c0, blocks.c1);  // words of lanes 0, 2, 4, 6
  const __m512i odd_01 = _mm512_unpackhi_epi64(blocks.c0, blocks.c1);
  const __m512i even_23 = _mm512_unpacklo_epi64(blocks.c2, blocks.c3);
  const __m512i odd_23 = _mm512_unpackhi_epi64(blocks.c2, blocks.c3);
  // Each of the next four vectors has the words of two lanes: 0x44 selects lanes 0 and 2 from the even vectors, and 1
  // and 3 from the odd vectors; 0xee selects lanes 4 and 6, and 5 and 7.
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

/// Writes the four words of each block from `first` on. Of `count` blocks it writes as many as fill whole groups of
/// vectors, and none on a computer without AVX-512. Returns the number of blocks written.
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

r123::Philox4x64::ctr_type block_at(const StreamAddress& address, std::uint64_t block) {
  const r123::Philox4x64::ctr_type counter{{address.factor.value, address.pose.value, block, 0}};
  const r123::Philox4x64::key_type key{{address.seed, static_cast<std::uint64_t>(address.purpose)}};
  return r123::Philox4x64{}(counter, key);
}

/// The value of uniform_from_bits(), in a form that is inlined into loops.
[[gnu::always_inline]] inline double middle_of_cell(std::uint64_t bits) {
  // Converts the cell, an integer below 2^53, to a double in two parts of 32 and 21 bits. Each part becomes the low
  // bits of a double with a large power of two, which is then subtracted. Unlike a conversion instruction, this is
  // vectorised on every instruction set; it is also exact.
  const std::uint64_t cell = bits >> 11;
  const std::uint64_t low = cell & 0xffffffff;
  const std::uint64_t high = cell >> 32;
  const double sum = (std::bit_cast<double>(high | std::bit_cast<std::uint64_t>(0x1p84)) - 0x1p84) +
                     (std::bit_cast<double>(low | std::bit_cast<std::uint64_t>(0x1p52)) - 0x1p52);
  // The middle of the last cell is not a double, and would be rounded to 1.
  return std::min((sum + 0.5) * 0x1p-53, 1.0 - 0x1p-53);
}

POESY_EACH_INSTRUCTION_SET void middles_of_cells(const std::uint64_t* bits, std::size_t count, double* uniforms) {
  for (std::size_t k = 0; k < count; ++k) uniforms[k] = middle_of_cell(bits[k]);
}

}  // namespace

std::uint64_t random_bits(const StreamAddress& address, SampleIndex sample) {
  return block_at(address, sample.value / kBlockWords)[sample.value % kBlockWords];
}

std::array<std::uint64_t, 4> random_block(const StreamAddress& address, std::uint64_t block) {
  std::array<std::uint64_t, kBlockWords> words;
  std::ranges::copy(block_at(address, block), words.begin());
  return words;
}

void fill_uniforms(const StreamAddress& address, SampleIndex first, std::span<double> uniforms) {
  // Philox is computed for whole blocks. The first block may begin before the first sample, and the last may end after
  // the last sample.
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
