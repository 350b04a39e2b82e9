#pragma once

#include <cstdint>

#include "bench/peak.h"

namespace poesy::bench {

/// More accumulators than two pipelines of five cycles can hold, and few enough for sixteen registers.
static constexpr int kAccumulators = 12;

/// x = x m + a, with m and a hidden from the optimiser.
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

}  // namespace poesy::bench
