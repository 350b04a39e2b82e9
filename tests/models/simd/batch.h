#pragma once

#include <cstddef>

#include "models/simd/math.h"

// The functions of a batch that the tests call. The interface has only pointers and numbers, because translation units
// compiled for one instruction set include it too.

namespace poesy::simd {

inline constexpr std::size_t kOperations = 11;

/// Functions that apply batch operations to rows of numbers. count: a multiple of 8.
struct Batch {
  void (*sin_cos)(const double* x, std::size_t count, double* sines, double* cosines);
  /// out: [kOperations x count] a + b, a - b, a b, a / b, a b + c, c - a b, sqrt |a|, the integer nearest to a, the
  /// larger and the smaller of a and b, and a sum of comparisons: 2 if (a > b and not b < c) or c > a, plus, if a < b,
  /// 4 by select and 1 by bits.
  void (*operate)(const double* a, const double* b, const double* c, std::size_t count, double* out);
};

Batch plain_batch();
Batch avx2_batch();
Batch avx512_batch();
Batch neon_batch();

/// Implements Batch::sin_cos for the number type T: simd::Number or a Pack.
template <class T>
void sin_cos_rows(const double* x, std::size_t count, double* sines, double* cosines) {
  for (std::size_t n = 0; n < count; n += T::kLanes) {
    const auto both = sin_cos(T::load(x + n));
    both.sin.store(sines + n);
    both.cos.store(cosines + n);
  }
}

template <class T>
void operate_rows(const double* a_row, const double* b_row, const double* c_row, std::size_t count, double* out) {
  for (std::size_t n = 0; n < count; n += T::kLanes) {
    const T a = T::load(a_row + n), b = T::load(b_row + n), c = T::load(c_row + n);
    const auto less = a < b;
    const auto mixed = ((a > b) & !(b < c)) | (c > a);
    const T words = select(less, T(4.0), T(0.0)) + select(mixed, T(2.0), T(0.0));
    const T results[kOperations] = {a + b,        a - b,      a * b,     a / b,     madd(a, b, c), nmadd(a, b, c),
                                    sqrt(abs(a)), nearest(a), max(a, b), min(a, b), words};
    for (std::size_t k = 0; k < kOperations; ++k) results[k].store(out + k * count + n);
    for (std::size_t lane = 0; lane < T::kLanes; ++lane) {
      if (any(less) && (bits(less) >> lane & 1u) != 0) out[(kOperations - 1) * count + n + lane] += 1.0;
    }
  }
}

}  // namespace poesy::simd
