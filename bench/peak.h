#pragma once

#include <cstdint>
#include <span>

namespace poesy::bench {

// Each function exists once for each instruction set, in a translation unit that is compiled for this set.

// Repeats independent multiply-adds of full vectors in registers. Returns the number of floating-point operations: two
// for each multiply-add and lane.
std::uint64_t multiply_adds_plain(std::uint64_t repetitions);
std::uint64_t multiply_adds_avx2(std::uint64_t repetitions);
std::uint64_t multiply_adds_avx512(std::uint64_t repetitions);

// Reads all numbers into full vectors, and adds them. Precondition: numbers.size() is a multiple of 64.
double sum_plain(std::span<const double> numbers);
double sum_avx2(std::span<const double> numbers);
double sum_avx512(std::span<const double> numbers);

}  // namespace poesy::bench
