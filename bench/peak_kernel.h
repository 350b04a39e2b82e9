#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "bench/peak.h"

namespace poesy::bench {

/// The number of independent accumulators. It exceeds the ten multiply-adds that two pipelines with a latency of five
/// cycles hold at a time, and all accumulators fit into sixteen registers.
static constexpr int kAccumulators = 12;

/// Repeats x = x m + a for all accumulators x. The first asm statement hides the values of m and a from the optimiser.
/// Returns the number of floating-point operations.
template <class Vector>
static std::uint64_t multiply_adds(std::uint64_t repetitions) {
  Vector x[kAccumulators] = {};
  Vector m = Vector{} + 0.999;
  Vector a = Vector{} + 1e-3;
  asm volatile("" : "+m"(m), "+m"(a));
  for (std::uint64_t n = 0; n < repetitions; ++n) {
    for (Vector& each : x) each = each * m + a;
  }
  for (Vector& each : x) asm volatile("" : : "m"(each));
  return repetitions * kAccumulators * (2 * sizeof(Vector) / sizeof(double));
}

template <class Vector>
static double sum(std::span<const double> numbers) {
  constexpr std::size_t kLanes = sizeof(Vector) / sizeof(double);
  constexpr std::size_t kSums = 8;
  Vector sums[kSums] = {};
  for (std::size_t at = 0; at < numbers.size(); at += kSums * kLanes) {
    for (std::size_t k = 0; k < kSums; ++k) {
      Vector read;
      std::memcpy(&read, &numbers[at + k * kLanes], sizeof(Vector));
      sums[k] += read;
    }
  }
  double total = 0.0;
  for (const Vector& each : sums) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) total += each[lane];
  }
  return total;
}

}  // namespace poesy::bench
