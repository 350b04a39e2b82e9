#pragma once

#include <cstdint>

namespace poesy::bench {

// One per instruction set, each compiled in a translation unit of its own: repeats independent multiply-adds of full
// vectors in registers and returns the number of floating-point operations, two for each multiply-add and lane.
std::uint64_t multiply_adds_plain(std::uint64_t repetitions);
std::uint64_t multiply_adds_avx2(std::uint64_t repetitions);
std::uint64_t multiply_adds_avx512(std::uint64_t repetitions);

}  // namespace poesy::bench
