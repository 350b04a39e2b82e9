#pragma once

#include "models/chain/block_kernel_class.h"
#include "models/simd/rotation.h"

namespace poesy::chain {

namespace kernel {

using simd::add_cross;
using simd::cross;
using simd::dot3;

/// The Lie bracket of two screws [w; v].
template <class Screw>
inline Screw bracket(const Screw& a, const Screw& b) {
  Screw c;
  cross(a.w, b.w, c.w);
  cross(a.w, b.v, c.v);
  add_cross(a.v, b.w, c.v);
  return c;
}

template <class Screw>
inline auto dot(const Screw& a, const Screw& b) {
  auto sum = a.w[0] * b.w[0];
  for (int n = 1; n < 3; ++n) sum = madd(a.w[n], b.w[n], sum);
  for (int n = 0; n < 3; ++n) sum = madd(a.v[n], b.v[n], sum);
  return sum;
}

/// Subtracts a multiple of a screw: rest -= share x a.
template <class T, class Screw>
inline void subtract(T share, const Screw& a, Screw& rest) {
  for (int n = 0; n < 3; ++n) {
    rest.w[n] = nmadd(share, a.w[n], rest.w[n]);
    rest.v[n] = nmadd(share, a.v[n], rest.v[n]);
  }
}

/// Adds a rotated vector: p += r shift, with the rotation matrix r.
template <class T>
inline void add_turned(const T* r, const T* shift, T* p) {
  for (int row = 0; row < 3; ++row) {
    p[row] = madd(r[3 * row + 2], shift[2], madd(r[3 * row + 1], shift[1], madd(r[3 * row], shift[0], p[row])));
  }
}

/// The product of motions g = a b; g may be the object a.
template <class Motion>
inline void multiply(const Motion& a, const Motion& b, Motion& g) {
  Motion c;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      c.r[3 * row + column] =
          madd(a.r[3 * row + 2], b.r[6 + column], madd(a.r[3 * row + 1], b.r[3 + column], a.r[3 * row] * b.r[column]));
    }
    c.p[row] = madd(a.r[3 * row + 2], b.p[2], madd(a.r[3 * row + 1], b.p[1], madd(a.r[3 * row], b.p[0], a.p[row])));
  }
  g = c;
}

/// The motion a b^-1.
template <class Motion>
inline Motion divide(const Motion& a, const Motion& b) {
  Motion c;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) c.r[3 * row + column] = dot3(a.r + 3 * row, b.r + 3 * column);
    c.p[row] = a.p[row];
  }
  for (int row = 0; row < 3; ++row) {
    for (int n = 0; n < 3; ++n) c.p[row] = nmadd(c.r[3 * row + n], b.p[n], c.p[row]);
  }
  return c;
}

}  // namespace kernel

/// Component number `entry` of a frame's error [omega; v], for the samples from `at` on, one in each lane.
template <class T, class Shape>
T BlockKernel<T, Shape>::varied(const KernelPiece& piece, int entry, std::size_t at) const {
  const int row = piece.varied_row[entry];
  return row < 0 ? T(piece.error[entry]) : value(static_cast<std::size_t>(row), at);
}

/// The motion Delta g of a frame's error (Du et al. 2022, Eq. 26), or its inverse if the piece is inverted.
template <class T, class Shape>
auto BlockKernel<T, Shape>::error_motion(const KernelPiece& piece, std::size_t at) const -> Motion {
  T e[6];
  for (int n = 0; n < 6; ++n) e[n] = varied(piece, n, at);
  const T x = kernel::dot3(e, e);
  auto coefficients = simd::exp_coefficients(x);
  coefficients.a = (piece.inverted ? T(-1.0) : T(1.0)) * coefficients.a;
  Motion g;
  simd::rotation_matrix(e, x, coefficients, g.r);
  for (int row = 0; row < 3; ++row) {
    g.p[row] = piece.inverted ? -kernel::dot3(g.r + 3 * row, e + 3) : e[3 + row];
  }
  return g;
}

template <class T, class Shape>
auto BlockKernel<T, Shape>::constant_motion(const KernelPiece& piece) -> Motion {
  Motion g;
  for (int k = 0; k < 9; ++k) g.r[k] = T(piece.constant[k]);
  for (int k = 0; k < 3; ++k) g.p[k] = T(piece.constant[9 + k]);
  return g;
}

/// Computes the motion of a segment, which is the product of its pieces. An error without a rotation needs no matrix
/// product: its translation is added to that of the product.
template <class T, class Shape>
void BlockKernel<T, Shape>::vary_segment(const KernelSegment& segment, std::size_t at, Motion& product) const {
  T shift[3] = {T(0.0), T(0.0), T(0.0)};
  bool is_empty = true;
  for (std::size_t n = 0; n < segment.pieces; ++n) {
    const KernelPiece& piece = chain_.piece[segment.first_piece + n];
    if (piece.is_error && !piece.turns) {
      T e[3];
      for (int k = 0; k < 3; ++k) e[k] = (piece.inverted ? T(-1.0) : T(1.0)) * varied(piece, k + 3, at);
      if (is_empty) {
        for (int k = 0; k < 3; ++k) shift[k] = shift[k] + e[k];
      } else {
        kernel::add_turned(product.r, e, product.p);
      }
      continue;
    }
    const Motion factor = piece.is_error ? error_motion(piece, at) : constant_motion(piece);
    if (is_empty) {
      product = factor;
      for (int k = 0; k < 3; ++k) product.p[k] = product.p[k] + shift[k];
      is_empty = false;
    } else {
      kernel::multiply(product, factor, product);
    }
  }
}

/// Computes the motions of the first `end` segments, except those that are the same in all samples.
template <class T, class Shape>
void BlockKernel<T, Shape>::vary_segments(std::size_t at, std::size_t end) {
  for (std::size_t s = 0; s < end; ++s) {
    if (!is_constant(chain_.segment[s])) vary_segment(chain_.segment[s], at, segment_[s]);
  }
}

template <class T, class Shape>
void BlockKernel<T, Shape>::load_constant_segments() {
  for (std::size_t s = 0; s < chain_.segments; ++s) {
    const KernelSegment& segment = chain_.segment[s];
    if (is_constant(segment)) segment_[s] = constant_motion(chain_.piece[segment.first_piece]);
  }
}

template <class T, class Shape>
bool BlockKernel<T, Shape>::is_constant(const KernelSegment& segment) const {
  return segment.pieces == 1 && !chain_.piece[segment.first_piece].is_error;
}

/// Sets a column of the spatial Jacobian (Du et al. 2022, Eqs. 32-39): the screw of a joint about or along this axis
/// through this point.
template <class T, class Shape>
void BlockKernel<T, Shape>::set_column(const KernelJoint& joint, const T* axis, const T* point, Screw& column) const {
  if (!joint.revolute) {
    for (int k = 0; k < 3; ++k) {
      column.w[k] = T(0.0);
      column.v[k] = axis[k];
    }
    return;
  }
  for (int k = 0; k < 3; ++k) column.w[k] = axis[k];
  kernel::cross(point, axis, column.v);
  if (joint.advance == 0.0) return;
  for (int k = 0; k < 3; ++k) column.v[k] = madd(T(joint.advance), axis[k], column.v[k]);
}

/// Computes the platform pose of a limb by Eq. 28 of Du et al. 2022, and its spatial Jacobian columns. A revolute joint
/// changes two columns of the rotation matrix; a prismatic joint changes the translation.
template <class T, class Shape>
void BlockKernel<T, Shape>::limb_pose(std::size_t i, Motion& pose) {
  // Each limb has one more segment than joints, so the segments of limb i begin at first_joint(i) + i.
  const Motion* segment = segment_ + i;
  Motion g = segment[first_joint(i)];
  for (std::size_t j = first_joint(i); j < first_joint(i + 1); ++j) {
    const T axis[3] = {g.r[2], g.r[5], g.r[8]};
    const T q = joint_[j];
    set_column(chain_.joint[j], axis, g.p, column_[j]);
    if (chain_.joint[j].revolute) {
      const auto [s, c] = simd::sin_cos(q);
      for (int row = 0; row < 3; ++row) {
        const T x = g.r[3 * row], y = g.r[3 * row + 1];
        g.r[3 * row] = madd(s, y, c * x);
        g.r[3 * row + 1] = nmadd(s, x, c * y);
      }
      if (const double advance = chain_.joint[j].advance; advance != 0.0) {
        for (int k = 0; k < 3; ++k) g.p[k] = madd(T(advance) * q, axis[k], g.p[k]);
      }
    } else {
      for (int k = 0; k < 3; ++k) g.p[k] = madd(q, axis[k], g.p[k]);
    }
    kernel::multiply(g, segment[j + 1], g);
  }
  pose = g;
}

template <class T, class Shape>
void BlockKernel<T, Shape>::residuals() {
  for (std::size_t i = 0; i < limbs(); ++i) limb_pose(i, pose_[i]);
  for (std::size_t n = 0; n < pairs(); ++n) {
    mu_[n] = log(kernel::divide(pose_[chain_.pair[n].k], pose_[chain_.pair[n].i]));
  }
}

template <class T, class Shape>
auto BlockKernel<T, Shape>::log(const Motion& g) -> Screw {
  const auto turn = simd::rotation_log(g.r);
  Screw screw;
  for (int k = 0; k < 3; ++k) screw.w[k] = turn.w[k];
  T once[3], twice[3];
  kernel::cross(screw.w, g.p, once);
  kernel::cross(screw.w, once, twice);
  for (int k = 0; k < 3; ++k) screw.v[k] = madd(turn.bend, twice[k], nmadd(T(0.5), once[k], g.p[k]));
  return screw;
}

}  // namespace poesy::chain
