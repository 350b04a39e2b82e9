#pragma once

// A SIMD batch of doubles that is used like one number. Only translation units compiled for one instruction set include
// this file. Every name is in a namespace of that set, so no inline function of one set can be linked into another.
#define HWY_COMPILE_ONLY_STATIC
#include <hwy/highway.h>

#include <cstddef>

namespace poesy::simd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<double>;

/// A truth value for each lane.
struct Mask {
  hn::Mask<Tag> m;  ///< the truth values of all lanes

  /// Logical operations lane by lane; `any` tells whether some lane is true.
  /// @{
  friend Mask operator&(Mask a, Mask b) { return {hn::And(a.m, b.m)}; }
  friend Mask operator|(Mask a, Mask b) { return {hn::Or(a.m, b.m)}; }
  friend Mask operator!(Mask a) { return {hn::Not(a.m)}; }
  friend bool any(Mask a) { return !hn::AllFalse(Tag(), a.m); }
  /// @}
  /// The mask as an integer: bit n is the truth value of lane n.
  friend unsigned bits(Mask a) {
    unsigned char bytes[8] = {};
    hn::StoreMaskBits(Tag(), a.m, bytes);
    return bytes[0];
  }
};

/// A SIMD batch of doubles. madd and nmadd round once, and every other operation is a single IEEE operation per lane.
/// So all instruction sets with fused multiply-add agree in every bit.
struct Pack {
  /// The type of the result of a comparison.
  using MaskType = Mask;
  /// The number of lanes of this instruction set.
  static constexpr std::size_t kLanes = hn::MaxLanes(Tag());

  hn::Vec<Tag> v;  ///< the lanes

  Pack() = default;
  /// The batch with these lanes.
  Pack(hn::Vec<Tag> lanes) : v(lanes) {}
  /// The batch with the same number in every lane.
  Pack(double value) : v(hn::Set(Tag(), value)) {}

  /// Reads kLanes doubles.
  static Pack load(const double* from) { return hn::LoadU(Tag(), from); }
  /// Writes kLanes doubles.
  void store(double* to) const { hn::StoreU(v, Tag(), to); }

  /// Arithmetic and comparisons lane by lane.
  /// @{
  friend Pack operator+(Pack a, Pack b) { return hn::Add(a.v, b.v); }
  friend Pack operator-(Pack a, Pack b) { return hn::Sub(a.v, b.v); }
  friend Pack operator*(Pack a, Pack b) { return hn::Mul(a.v, b.v); }
  friend Pack operator/(Pack a, Pack b) { return hn::Div(a.v, b.v); }
  friend Pack operator-(Pack a) { return hn::Neg(a.v); }
  friend Mask operator<(Pack a, Pack b) { return {hn::Lt(a.v, b.v)}; }
  friend Mask operator>(Pack a, Pack b) { return {hn::Gt(a.v, b.v)}; }
  /// @}

  /// The fused product and sum a b + c.
  friend Pack madd(Pack a, Pack b, Pack c) { return hn::MulAdd(a.v, b.v, c.v); }
  /// The fused difference c - a b.
  friend Pack nmadd(Pack a, Pack b, Pack c) { return hn::NegMulAdd(a.v, b.v, c.v); }
  /// Selection and functions lane by lane.
  /// @{
  friend Pack select(Mask mask, Pack yes, Pack no) { return hn::IfThenElse(mask.m, yes.v, no.v); }
  friend Pack sqrt(Pack a) { return hn::Sqrt(a.v); }
  friend Pack abs(Pack a) { return hn::Abs(a.v); }
  friend Pack max(Pack a, Pack b) { return hn::Max(a.v, b.v); }
  friend Pack min(Pack a, Pack b) { return hn::Min(a.v, b.v); }
  /// @}
  /// Rounds to the nearest whole number, ties to even.
  friend Pack nearest(Pack a) { return hn::Round(a.v); }
};

}  // namespace poesy::simd::HWY_NAMESPACE
