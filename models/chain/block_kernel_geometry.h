#pragma once

#include "models/chain/block_kernel_class.h"

namespace poesy::chain {

namespace kernel {

/// a x b
template <class T>
inline void cross(const T* a, const T* b, T* c) {
  c[0] = nmadd(a[2], b[1], a[1] * b[2]);
  c[1] = nmadd(a[0], b[2], a[2] * b[0]);
  c[2] = nmadd(a[1], b[0], a[0] * b[1]);
}

/// c += a x b
template <class T>
inline void add_cross(const T* a, const T* b, T* c) {
  c[0] = nmadd(a[2], b[1], madd(a[1], b[2], c[0]));
  c[1] = nmadd(a[0], b[2], madd(a[2], b[0], c[1]));
  c[2] = nmadd(a[1], b[0], madd(a[0], b[1], c[2]));
}

template <class T>
inline T dot3(const T* a, const T* b) {
  return madd(a[2], b[2], madd(a[1], b[1], a[0] * b[0]));
}

/// Lie bracket of screws [w; v].
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

/// g = a b; g may be a.
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

/// a b^-1
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

// Taylor series in x = theta^2, exact to rounding below the angle given.
inline constexpr double kSincSeries[] = {1.0,           -1.0 / 6.0,        1.0 / 120.0,        -1.0 / 5040.0,
                                         1.0 / 362880., -1.0 / 39916800.0, 1.0 / 6227020800.0, -1.0 / 1307674368000.0};
inline constexpr double kCoscSeries[] = {
    1.0 / 2.0,       -1.0 / 24.0,        1.0 / 720.0,         -1.0 / 40320.0,
    1.0 / 3628800.0, -1.0 / 479001600.0, 1.0 / 87178291200.0, -1.0 / 20922789888000.0};
/// (1 - theta/2 cot(theta/2)) / theta^2 below 0.75 rad.
inline constexpr double kCotSeries[] = {1.0 / 12.0,
                                        1.0 / 720.0,
                                        1.0 / 30240.0,
                                        1.0 / 1209600.0,
                                        1.0 / 47900160.0,
                                        691.0 / 1307674368000.0,
                                        1.0 / 74724249600.0,
                                        3617.0 / 10670622842880000.0,
                                        43867.0 / 5109094217170944000.0};
/// atan(t) / t in t^2, for |t| <= 0.415: tan(pi/8).
inline constexpr double kAtanSeries[] = {1.0,        -1.0 / 3.0,  1.0 / 5.0,  -1.0 / 7.0,  1.0 / 9.0,  -1.0 / 11.0,
                                         1.0 / 13.0, -1.0 / 15.0, 1.0 / 17.0, -1.0 / 19.0, 1.0 / 21.0, -1.0 / 23.0,
                                         1.0 / 25.0, -1.0 / 27.0, 1.0 / 29.0, -1.0 / 31.0, 1.0 / 33.0, -1.0 / 35.0,
                                         1.0 / 37.0, -1.0 / 39.0, 1.0 / 41.0, -1.0 / 43.0};
/// The first terms of the same, for |t| <= 0.335.
inline constexpr double kAtanShort[] = {1.0,        -1.0 / 3.0,  1.0 / 5.0,  -1.0 / 7.0,  1.0 / 9.0,  -1.0 / 11.0,
                                        1.0 / 13.0, -1.0 / 15.0, 1.0 / 17.0, -1.0 / 19.0, 1.0 / 21.0, -1.0 / 23.0,
                                        1.0 / 25.0, -1.0 / 27.0, 1.0 / 29.0, -1.0 / 31.0, 1.0 / 33.0};

}  // namespace kernel

/// Delta g of Eq. 26, or its inverse.
template <class T, class Shape>
auto BlockKernel<T, Shape>::error_motion(const KernelPiece& piece, std::size_t at) const -> Motion {
  T e[6];
  for (int n = 0; n < 6; ++n) {
    const int row = piece.varied_row[n];
    e[n] = row < 0 ? T(piece.error[n]) : T::load(value_ + static_cast<std::size_t>(row) * capacity_ + at);
  }
  const T x = kernel::dot3(e, e);
  T a = simd::polynomial(x, kernel::kSincSeries);
  T b = simd::polynomial(x, kernel::kCoscSeries);
  const auto large = x > T(0.25);
  if (any(large)) {
    const T safe = select(large, x, T(1.0));
    const T theta = sqrt(safe);
    const auto [s, c] = simd::sin_cos(theta);
    a = select(large, s / theta, a);
    b = select(large, (T(1.0) - c) / safe, b);
  }
  const T sign = piece.inverted ? T(-1.0) : T(1.0);
  // R = (1 - b x) I + sign a hat(e) + b e e^T
  const T diagonal = nmadd(b, x, T(1.0));
  Motion g;
  for (int row = 0; row < 3; ++row) {
    const T scaled = b * e[row];
    for (int column = 0; column < 3; ++column) g.r[3 * row + column] = scaled * e[column];
    g.r[4 * row] = g.r[4 * row] + diagonal;
  }
  const T turn = sign * a;
  g.r[1] = nmadd(turn, e[2], g.r[1]);
  g.r[2] = madd(turn, e[1], g.r[2]);
  g.r[3] = madd(turn, e[2], g.r[3]);
  g.r[5] = nmadd(turn, e[0], g.r[5]);
  g.r[6] = nmadd(turn, e[1], g.r[6]);
  g.r[7] = madd(turn, e[0], g.r[7]);
  for (int row = 0; row < 3; ++row) {
    g.p[row] = piece.inverted ? -kernel::dot3(g.r + 3 * row, e + 3) : e[3 + row];
  }
  return g;
}

template <class T, class Shape>
void BlockKernel<T, Shape>::vary_segments(std::size_t at) {
  for (std::size_t s = 0; s < chain_.segments; ++s) {
    const KernelSegment& segment = chain_.segment[s];
    if (segment.pieces == 1 && !chain_.piece[segment.first_piece].is_error) continue;
    Motion product;
    for (std::size_t n = 0; n < segment.pieces; ++n) {
      const KernelPiece& piece = chain_.piece[segment.first_piece + n];
      Motion factor;
      if (piece.is_error) {
        factor = error_motion(piece, at);
      } else {
        for (int k = 0; k < 9; ++k) factor.r[k] = T(piece.constant[k]);
        for (int k = 0; k < 3; ++k) factor.p[k] = T(piece.constant[9 + k]);
      }
      if (n == 0) {
        product = factor;
      } else {
        kernel::multiply(product, factor, product);
      }
    }
    segment_[s] = product;
  }
}

/// Eq. 28, with the spatial Jacobian columns of Eqs. 32-39 on the way. A joint touches two columns of R, or p.
template <class T, class Shape>
void BlockKernel<T, Shape>::limb_pose(std::size_t i, Motion& pose) {
  // Each limb before this one has a segment more than joints.
  const Motion* segment = segment_ + i;
  Motion g = segment[first_joint(i)];
  for (std::size_t j = first_joint(i); j < first_joint(i + 1); ++j) {
    Screw& column = column_[j];
    const T axis[3] = {g.r[2], g.r[5], g.r[8]};
    const T q = joint_[j];
    if (chain_.joint[j].revolute) {
      for (int k = 0; k < 3; ++k) column.w[k] = axis[k];
      kernel::cross(g.p, axis, column.v);
      const auto [s, c] = simd::sin_cos(q);
      for (int row = 0; row < 3; ++row) {
        const T x = g.r[3 * row], y = g.r[3 * row + 1];
        g.r[3 * row] = madd(s, y, c * x);
        g.r[3 * row + 1] = nmadd(s, x, c * y);
      }
    } else {
      for (int k = 0; k < 3; ++k) {
        column.w[k] = T(0.0);
        column.v[k] = axis[k];
        g.p[k] = madd(q, axis[k], g.p[k]);
      }
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

/// Logarithm for rotations by less than a half turn. Angles come from tan(theta/2) = s / (1 + c), exact at small
/// angles, where residuals live; beyond 37 degrees, from tan(theta/8).
template <class T, class Shape>
auto BlockKernel<T, Shape>::log(const Motion& g) -> Screw {
  const T half(0.5);
  T a[3] = {half * (g.r[7] - g.r[5]), half * (g.r[2] - g.r[6]), half * (g.r[3] - g.r[1])};
  const T sine2 = kernel::dot3(a, a);
  const T cosine = half * (g.r[0] + g.r[4] + g.r[8] - T(1.0));
  const T denominator = T(1.0) / (T(1.0) + cosine);
  const T tan2 = sine2 * denominator * denominator;
  T factor = (denominator + denominator) * simd::polynomial(tan2, kernel::kAtanShort);  // theta / sin(theta)
  T theta2 = factor * factor * sine2;
  T bend = simd::polynomial(theta2, kernel::kCotSeries);
  const auto wide = !(tan2 < T(0.1111));
  if (any(wide)) {
    const T half_tan = sqrt(select(wide, tan2, T(1.0)));
    const T quarter = half_tan / (T(1.0) + sqrt(madd(half_tan, half_tan, T(1.0))));
    const T eighth = quarter / (T(1.0) + sqrt(madd(quarter, quarter, T(1.0))));
    const T theta = T(8.0) * eighth * simd::polynomial(eighth * eighth, kernel::kAtanSeries);
    factor = select(wide, theta / sqrt(select(wide, sine2, T(1.0))), factor);
    theta2 = select(wide, theta * theta, theta2);
    bend = select(wide, (T(1.0) - half * theta / half_tan) / (theta * theta), bend);
  }
  Screw screw;
  for (int k = 0; k < 3; ++k) screw.w[k] = factor * a[k];
  T once[3], twice[3];
  kernel::cross(screw.w, g.p, once);
  kernel::cross(screw.w, once, twice);
  for (int k = 0; k < 3; ++k) screw.v[k] = madd(bend, twice[k], nmadd(half, once[k], g.p[k]));
  return screw;
}

}  // namespace poesy::chain
