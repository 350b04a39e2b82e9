#pragma once

#include <cstdint>

#include "models/simd/number.h"

namespace poesy::bench {

/// Numbers of floating-point operations of CountingNumber since operation_counts was last set to zero. Comparisons,
/// selections, changes of sign, magnitudes, minima, maxima and roundings are not counted.
struct OperationCounts {
  std::uint64_t additions = 0;  ///< additions and subtractions
  std::uint64_t multiplications = 0;
  std::uint64_t multiply_adds = 0;
  std::uint64_t divisions = 0;
  std::uint64_t roots = 0;

  /// The number of operations. A multiply-add counts as two, every other operation as one.
  std::uint64_t total() const { return additions + multiplications + 2 * multiply_adds + divisions + roots; }
};
inline OperationCounts operation_counts;

/// A simd::Number that counts its operations in operation_counts. It is as large as a double, because kernels get their
/// scratch memory as an array of doubles.
struct CountingNumber {
  using Number = simd::Number;
  using MaskType = simd::NumberMask;
  static constexpr std::size_t kLanes = 1;

  Number n;

  CountingNumber() = default;
  CountingNumber(double value) : n(value) {}
  CountingNumber(Number value) : n(value) {}

  static CountingNumber load(const double* from) { return Number::load(from); }
  void store(double* to) const { n.store(to); }

  friend CountingNumber operator+(CountingNumber a, CountingNumber b) {
    ++operation_counts.additions;
    return a.n + b.n;
  }
  friend CountingNumber operator-(CountingNumber a, CountingNumber b) {
    ++operation_counts.additions;
    return a.n - b.n;
  }
  friend CountingNumber operator*(CountingNumber a, CountingNumber b) {
    ++operation_counts.multiplications;
    return a.n * b.n;
  }
  friend CountingNumber operator/(CountingNumber a, CountingNumber b) {
    ++operation_counts.divisions;
    return a.n / b.n;
  }
  friend CountingNumber madd(CountingNumber a, CountingNumber b, CountingNumber c) {
    ++operation_counts.multiply_adds;
    return madd(a.n, b.n, c.n);
  }
  friend CountingNumber nmadd(CountingNumber a, CountingNumber b, CountingNumber c) {
    ++operation_counts.multiply_adds;
    return nmadd(a.n, b.n, c.n);
  }
  friend CountingNumber sqrt(CountingNumber a) {
    ++operation_counts.roots;
    return sqrt(a.n);
  }

  friend CountingNumber operator-(CountingNumber a) { return -a.n; }
  friend MaskType operator<(CountingNumber a, CountingNumber b) { return a.n < b.n; }
  friend MaskType operator>(CountingNumber a, CountingNumber b) { return a.n > b.n; }
  friend CountingNumber select(MaskType mask, CountingNumber yes, CountingNumber no) {
    return select(mask, yes.n, no.n);
  }
  friend CountingNumber abs(CountingNumber a) { return abs(a.n); }
  friend CountingNumber max(CountingNumber a, CountingNumber b) { return max(a.n, b.n); }
  friend CountingNumber min(CountingNumber a, CountingNumber b) { return min(a.n, b.n); }
  friend CountingNumber nearest(CountingNumber a) { return nearest(a.n); }
};
static_assert(sizeof(CountingNumber) == sizeof(double));

}  // namespace poesy::bench
