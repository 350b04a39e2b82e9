#pragma once

#include <cmath>
#include <cstddef>

namespace poesy::simd {

/// A truth value with the interface of a SIMD mask.
struct NumberMask {
  bool m;  ///< the truth value

  /// Operations on truth values.
  /// @{
  friend NumberMask operator&(NumberMask a, NumberMask b) { return {a.m && b.m}; }
  friend NumberMask operator|(NumberMask a, NumberMask b) { return {a.m || b.m}; }
  friend NumberMask operator!(NumberMask a) { return {!a.m}; }
  friend bool any(NumberMask a) { return a.m; }
  friend unsigned bits(NumberMask a) { return a.m ? 1u : 0u; }
  /// @}
};

/// A double with the interface of a SIMD batch. Tests compare all batches with it, and it is the portable fallback.
struct Number {
  /// The type of the result of a comparison.
  using MaskType = NumberMask;
  static constexpr std::size_t kLanes = 1;  ///< number of lanes

  double v;  ///< the number

  Number() = default;
  /// The conversion is implicit, so that formulas may contain constants.
  Number(double value) : v(value) {}

  /// Reads one double.
  static Number load(const double* from) { return *from; }
  /// Writes one double.
  void store(double* to) const { *to = v; }

  /// Arithmetic and comparisons of doubles.
  /// @{
  friend Number operator+(Number a, Number b) { return a.v + b.v; }
  friend Number operator-(Number a, Number b) { return a.v - b.v; }
  friend Number operator*(Number a, Number b) { return a.v * b.v; }
  friend Number operator/(Number a, Number b) { return a.v / b.v; }
  friend Number operator-(Number a) { return -a.v; }
  friend NumberMask operator<(Number a, Number b) { return {a.v < b.v}; }
  friend NumberMask operator>(Number a, Number b) { return {a.v > b.v}; }
  /// @}

  /// The functions of Pack for one double. Here madd and nmadd round twice.
  /// @{
  friend Number madd(Number a, Number b, Number c) { return a.v * b.v + c.v; }
  friend Number nmadd(Number a, Number b, Number c) { return c.v - a.v * b.v; }
  friend Number select(NumberMask mask, Number yes, Number no) { return mask.m ? yes : no; }
  friend Number sqrt(Number a) { return std::sqrt(a.v); }
  friend Number abs(Number a) { return std::abs(a.v); }
  friend Number max(Number a, Number b) { return a.v > b.v ? a : b; }
  friend Number min(Number a, Number b) { return a.v < b.v ? a : b; }
  friend Number nearest(Number a) { return std::nearbyint(a.v); }
  /// @}
};

}  // namespace poesy::simd
