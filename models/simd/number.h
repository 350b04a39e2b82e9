#pragma once

#include <cmath>
#include <cstddef>

namespace poesy::simd {

/// A truth value behind the same words as a batch of them.
struct NumberMask {
  bool m;  ///< the one lane

  /// Of the one lane.
  /// @{
  friend NumberMask operator&(NumberMask a, NumberMask b) { return {a.m && b.m}; }
  friend NumberMask operator|(NumberMask a, NumberMask b) { return {a.m || b.m}; }
  friend NumberMask operator!(NumberMask a) { return {!a.m}; }
  friend bool any(NumberMask a) { return a.m; }
  friend unsigned bits(NumberMask a) { return a.m ? 1u : 0u; }
  /// @}
};

/// A plain double behind the same words as a batch: the reference for every batch, and the portable fallback.
struct Number {
  /// What comparisons give.
  using MaskType = NumberMask;
  static constexpr std::size_t kLanes = 1;  ///< one

  double v;  ///< the lane

  Number() = default;
  /// Implicit, so that constants may stand in formulas.
  Number(double value) : v(value) {}

  /// From one place in memory.
  static Number load(const double* from) { return *from; }
  /// To one place in memory.
  void store(double* to) const { *to = v; }

  /// As doubles.
  /// @{
  friend Number operator+(Number a, Number b) { return a.v + b.v; }
  friend Number operator-(Number a, Number b) { return a.v - b.v; }
  friend Number operator*(Number a, Number b) { return a.v * b.v; }
  friend Number operator/(Number a, Number b) { return a.v / b.v; }
  friend Number operator-(Number a) { return -a.v; }
  friend NumberMask operator<(Number a, Number b) { return {a.v < b.v}; }
  friend NumberMask operator>(Number a, Number b) { return {a.v > b.v}; }
  /// @}

  /// As Pack, with a rounding after each operation.
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
