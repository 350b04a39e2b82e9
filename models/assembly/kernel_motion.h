#pragma once

// This header belongs to kernels.cpp alone, which is compiled once for each instruction set.

#include "models/assembly/kernel_problem.h"
#include "models/simd/rotation.h"

namespace poesy::assembly {

/// A rigid motion in each lane.
template <class T>
struct LaneMotion {
  T r[9];  ///< rotation matrix, row by row
  T p[3];  ///< translation
};

/// Copies one rigid motion into all lanes.
template <class T>
LaneMotion<T> in_lanes(const KernelMotion& motion) {
  LaneMotion<T> made;
  for (int k = 0; k < 9; ++k) made.r[k] = T(motion.r[k]);
  for (int k = 0; k < 3; ++k) made.p[k] = T(motion.p[k]);
  return made;
}

/// The product of motions a b.
template <class T>
[[gnu::always_inline]] inline LaneMotion<T> product(const LaneMotion<T>& a, const LaneMotion<T>& b) {
  LaneMotion<T> c;
  for (int row = 0; row < 3; ++row) {
    const T* of_a = a.r + 3 * row;
    for (int column = 0; column < 3; ++column) {
      c.r[3 * row + column] = madd(of_a[2], b.r[6 + column], madd(of_a[1], b.r[3 + column], of_a[0] * b.r[column]));
    }
    c.p[row] = madd(of_a[2], b.p[2], madd(of_a[1], b.p[1], madd(of_a[0], b.p[0], a.p[row])));
  }
  return c;
}

/// Moves a frame g by a translation t along the axes of g: g := g x translation.
template <class T>
[[gnu::always_inline]] inline void shift(LaneMotion<T>& g, const T* t) {
  for (int row = 0; row < 3; ++row) {
    const T* of = g.r + 3 * row;
    g.p[row] = madd(of[2], t[2], madd(of[1], t[1], madd(of[0], t[0], g.p[row])));
  }
}

/// Moves a frame g by a constant motion: g := g x motion.
template <class T>
[[gnu::always_inline]] inline void append(LaneMotion<T>& g, const KernelConstant& constant) {
  if (constant.shape == KernelConstant::Shape::identity) return;
  const LaneMotion<T> other = in_lanes<T>(constant.motion);
  if (constant.shape == KernelConstant::Shape::translation) {
    shift(g, other.p);
  } else {
    g = product(g, other);
  }
}

/// Moves a frame g by the motion of a joint: g := g x motion. displacement: rad or in units of the reach.
template <class T>
[[gnu::always_inline]] inline void move(const KernelJoint& joint, T displacement, LaneMotion<T>& g) {
  if (joint.slides || joint.advance != 0.0) {
    const T way = joint.slides ? displacement : T(joint.advance) * displacement;
    for (int row = 0; row < 3; ++row) g.p[row] = madd(g.r[3 * row + 2], way, g.p[row]);
  }
  if (joint.slides) return;
  const auto [sine, cosine] = simd::sin_cos(displacement);
  for (int row = 0; row < 3; ++row) {
    T* of = g.r + 3 * row;
    const T x = of[0];
    of[0] = madd(sine, of[1], cosine * x);
    of[1] = nmadd(sine, x, cosine * of[1]);
  }
}

/// Computes the twist [w; v] per unit displacement of a joint with the frame g, at the origin of the kernel's frame.
template <class T>
[[gnu::always_inline]] inline void twist_of(const KernelJoint& joint, const LaneMotion<T>& g, T* twist) {
  const T axis[3] = {g.r[2], g.r[5], g.r[8]};
  if (joint.slides) {
    for (int k = 0; k < 3; ++k) {
      twist[k] = T(0.0);
      twist[3 + k] = axis[k];
    }
    return;
  }
  for (int k = 0; k < 3; ++k) twist[k] = axis[k];
  simd::cross(g.p, axis, twist + 3);
  if (joint.advance == 0.0) return;
  for (int k = 0; k < 3; ++k) twist[3 + k] = madd(T(joint.advance), axis[k], twist[3 + k]);
}

/// The scalar product of two vectors of six numbers, such as a twist and a wrench.
template <class T>
[[gnu::always_inline]] inline T dot6(const T* a, const T* b) {
  return simd::dot3(a, b) + simd::dot3(a + 3, b + 3);
}

/// The rigid motion exp(twist) of a twist [w; v].
template <class T>
[[gnu::always_inline]] inline LaneMotion<T> motion_of(const T* twist) {
  const T* w = twist;
  const T* v = twist + 3;
  const T x = simd::dot3(w, w);
  const auto turn = simd::exp_coefficients(x);
  const auto left = simd::left_jacobian_coefficients(x);
  LaneMotion<T> made;
  simd::rotation_matrix(w, x, turn, made.r);
  T once[3];
  T twice[3];
  simd::cross(w, v, once);
  simd::cross(w, once, twice);
  for (int k = 0; k < 3; ++k) made.p[k] = madd(left.c, twice[k], madd(left.b, once[k], v[k]));
  return made;
}

/// Like simd::rotation_log(), but with shorter series for lanes in which tan(theta/2)^2 of the rotation angle theta is
/// below 1e-3, as is usual in mismatches.
template <class T>
[[gnu::always_inline]] inline simd::RotationLog<T> mismatch_log(const T* r) {
  static constexpr double kAtan[] = {1.0, -1.0 / 3.0, 1.0 / 5.0, -1.0 / 7.0, 1.0 / 9.0, -1.0 / 11.0};
  static constexpr double kCot[] = {1.0 / 12.0, 1.0 / 720.0, 1.0 / 30240.0, 1.0 / 1209600.0, 1.0 / 47900160.0};
  const T half(0.5);
  const T a[3] = {half * (r[7] - r[5]), half * (r[2] - r[6]), half * (r[3] - r[1])};
  const T sine2 = simd::dot3(a, a);
  const T denominator = T(1.0) / madd(half, r[0] + r[4] + r[8], half);  // 1 / (1 + cosine)
  const T tan2 = sine2 * denominator * denominator;
  const T factor = (denominator + denominator) * simd::polynomial(tan2, kAtan);
  simd::RotationLog<T> made{{factor * a[0], factor * a[1], factor * a[2]},
                            simd::polynomial(factor * factor * sine2, kCot)};
  const auto wide = !(tan2 < T(1e-3));
  if (!any(wide)) return made;
  const simd::RotationLog<T> full = simd::rotation_log(r);
  for (int k = 0; k < 3; ++k) made.w[k] = select(wide, full.w[k], made.w[k]);
  made.bend = select(wide, full.bend, made.bend);
  return made;
}

/// Computes the twist log(a b^-1) as [w; v].
template <class T>
[[gnu::always_inline]] inline void log_of(const LaneMotion<T>& a, const LaneMotion<T>& b, T* twist) {
  LaneMotion<T> c;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) c.r[3 * row + column] = simd::dot3(a.r + 3 * row, b.r + 3 * column);
    c.p[row] = a.p[row];
  }
  for (int row = 0; row < 3; ++row) {
    for (int n = 0; n < 3; ++n) c.p[row] = nmadd(c.r[3 * row + n], b.p[n], c.p[row]);
  }
  const auto turn = mismatch_log(c.r);
  T once[3];
  T twice[3];
  simd::cross(turn.w, c.p, once);
  simd::cross(turn.w, once, twice);
  for (int k = 0; k < 3; ++k) {
    twist[k] = turn.w[k];
    twist[3 + k] = madd(turn.bend, twice[k], nmadd(T(0.5), once[k], c.p[k]));
  }
}

/// The errors of consecutive samples as motions, one sample in each lane.
template <class T>
class LaneErrors {
 public:
  /// at: index of the sample in the first lane.
  LaneErrors(const KernelBlock& block, std::size_t at) : values_(block.values + at), stride_(block.stride) {}

  /// The motion of a segment between two joints, with errors.
  LaneMotion<T> segment(const KernelSegment& segment) const {
    if (segment.pieces.empty()) return in_lanes<T>(segment.behind.motion);
    LaneMotion<T> g = in_lanes<T>(segment.pieces.front().before.motion);
    for (const KernelPiece& piece : segment.pieces) {
      if (&piece != &segment.pieces.front()) append(g, piece.before);
      add(piece.error, g);
    }
    append(g, segment.behind);
    return g;
  }

 private:
  T entry(const KernelError& error, int n) const {
    const int row = error.varied[n];
    if (row < 0) return T(error.constant[n]);
    return T(error.unit[n]) * T::load(values_ + static_cast<std::size_t>(row) * stride_);
  }

  /// Moves a frame g by an error: g := g x error.
  void add(const KernelError& error, LaneMotion<T>& g) const {
    T e[6];
    for (int n = 0; n < 6; ++n) e[n] = entry(error, n);
    if (!error.turns) {
      for (int k = 3; k < 6; ++k) e[k] = error.inverted ? -e[k] : e[k];
      shift(g, e + 3);
      return;
    }
    LaneMotion<T> made;
    const T x = simd::dot3(e, e);
    auto turn = simd::exp_coefficients(x);
    if (error.inverted) turn.a = -turn.a;
    simd::rotation_matrix(e, x, turn, made.r);
    for (int row = 0; row < 3; ++row) {
      made.p[row] = error.inverted ? -simd::dot3(made.r + 3 * row, e + 3) : e[3 + row];
    }
    g = product(g, made);
  }

  const double* values_;
  std::size_t stride_;
};

}  // namespace poesy::assembly
