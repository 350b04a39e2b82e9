#pragma once

#include "models/simd/rotation.h"
#include "models/three_prs/closure_kernel_class.h"

namespace poesy::three_prs {

namespace kernel {

/// exp(w) x
template <class T>
inline void rotate(const T* w, const simd::ExpCoefficients<T>& c, T* x) {
  T once[3], twice[3];
  simd::cross(w, x, once);
  simd::cross(w, once, twice);
  for (int k = 0; k < 3; ++k) x[k] = madd(c.b, twice[k], madd(c.a, once[k], x[k]));
}

/// exp(w) e_y
template <class T>
inline void second_column(const T* w, const simd::ExpCoefficients<T>& c, T* x) {
  const T scaled = c.b * w[1];
  x[0] = nmadd(c.a, w[2], scaled * w[0]);
  x[1] = nmadd(c.b, madd(w[2], w[2], w[0] * w[0]), T(1.0));
  x[2] = madd(c.a, w[0], scaled * w[2]);
}

/// Turns x about z.
template <class T>
inline void turn(double cosine, double sine, T* x) {
  const T before = x[0];
  x[0] = nmadd(T(sine), x[1], T(cosine) * before);
  x[1] = madd(T(sine), before, T(cosine) * x[1]);
}

}  // namespace kernel

template <class T>
auto ClosureKernel<T>::limb_with_errors(const ClosureLimb& limb, std::size_t at) const -> Limb {
  T error[kSources];
  for (std::size_t n = 0; n < kSources; ++n) {
    const int row = limb.varied_row[n];
    error[n] =
        row < 0 ? T(limb.error[n]) : T::load(tile_.values + static_cast<std::size_t>(row) * tile_.values_stride + at);
  }
  const T* a = error + static_cast<std::size_t>(Source::a);
  const T* theta_A = error + static_cast<std::size_t>(Source::theta_A);
  const T* b = error + static_cast<std::size_t>(Source::b);
  const T* theta_B = error + static_cast<std::size_t>(Source::theta_B);
  const T* theta_Bp = error + static_cast<std::size_t>(Source::theta_Bp);
  const T* c = error + static_cast<std::size_t>(Source::c);
  const T angle2_A = simd::dot3(theta_A, theta_A);
  const T angle2_B = simd::dot3(theta_B, theta_B);
  const T angle2_Bp = simd::dot3(theta_Bp, theta_Bp);
  const auto exp_A = simd::exp_coefficients(angle2_A);
  const auto exp_B = simd::exp_coefficients(angle2_B);
  const auto exp_Bp = simd::exp_coefficients(angle2_Bp);

  Limb out;
  for (int k = 0; k < 3; ++k) {
    out.carriage[k] = b[k];
    const double* row = limb.base_R_platform_limb + 3 * k;
    out.joint[k] = madd(T(row[2]), c[2], madd(T(row[1]), c[1], madd(T(row[0]), c[0], T(limb.joint[k]))));
  }
  kernel::rotate(theta_B, exp_B, out.carriage);
  kernel::second_column(theta_B, exp_B, out.axis);
  out.carriage[2] = out.carriage[2] + (T(limb.q) + error[static_cast<std::size_t>(Source::q)]);
  kernel::rotate(theta_A, exp_A, out.carriage);
  kernel::rotate(theta_A, exp_A, out.axis);
  out.carriage[0] = out.carriage[0] + T(pose_.a);
  for (int k = 0; k < 3; ++k) out.carriage[k] = out.carriage[k] + a[k];
  kernel::turn(limb.cosine, limb.sine, out.carriage);
  kernel::turn(limb.cosine, limb.sine, out.axis);

  const T length = T(pose_.l) + error[static_cast<std::size_t>(Source::l)];
  out.rod_y = length * nmadd(exp_Bp.a, theta_Bp[0], exp_Bp.b * theta_Bp[1] * theta_Bp[2]);
  // Where an angle is beyond the sine's range, no equation has a value, and the sample is given up.
  const T largest = max(angle2_A, max(angle2_B, angle2_Bp));
  out.length2 = select(largest < T(kLargestAngle2), length * length, T(__builtin_nan("")));
  return out;
}

template <class T>
void ClosureKernel<T>::evaluate(const Group& group, Equations& equations) const {
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const Limb& limb = group.limb[i];
    T* joint = equations.joint[i];
    T* rod = equations.rod[i];
    for (int k = 0; k < 3; ++k) {
      joint[k] = simd::dot3(group.E + 3 * k, limb.joint);
      rod[k] = (T(pose_.r[k]) + group.dr[k]) + joint[k] - limb.carriage[k];
    }
    equations.value[i] = T(0.5) * (simd::dot3(rod, rod) - limb.length2);
    equations.value[i + 3] = simd::dot3(limb.axis, rod) - limb.rod_y;
  }
}

/// The step of the nominal Jacobian from no motion, with which solves start. Returns where it can be taken.
template <class T>
auto ClosureKernel<T>::first_step(const Group& group, T* step) const -> Mask {
  Equations equations;
  evaluate(group, equations);
  T size(0.0);
  for (int k = 0; k < 6; ++k) {
    const double* row = pose_.start + 6 * k;
    step[k] = T(row[0]) * equations.value[0];
    for (int n = 1; n < 6; ++n) step[k] = madd(T(row[n]), equations.value[n], step[k]);
    size = size + abs(step[k]);
  }
  return size < T(kLargestStep);
}

/// x of m = [A | b], A x = b. Returns where no pivot is small beside the others.
template <class T>
auto ClosureKernel<T>::eliminate(T (&m)[6][7], T* x) -> Mask {
  T inverse[6];
  T smallest = abs(m[0][0]), largest = smallest;
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    const T pivot = abs(m[k][k]);
    smallest = min(smallest, pivot);
    largest = max(largest, pivot);
    inverse[k] = T(1.0) / m[k][k];
#pragma GCC unroll 6
    for (int row = k + 1; row < 6; ++row) {
      const T factor = m[row][k] * inverse[k];
#pragma GCC unroll 7
      for (int column = k + 1; column < 7; ++column) {
        m[row][column] = nmadd(factor, m[k][column], m[row][column]);
      }
    }
  }
#pragma GCC unroll 6
  for (int k = 5; k >= 0; --k) {
    T sum = m[k][6];
#pragma GCC unroll 6
    for (int column = k + 1; column < 6; ++column) sum = nmadd(m[k][column], x[column], sum);
    x[k] = sum * inverse[k];
  }
  return smallest > T(kPivotRatio) * largest;
}

/// step: [delta; dr]. Returns where it can be taken.
template <class T>
auto ClosureKernel<T>::newton_step(const Group& group, T* step) const -> Mask {
  Equations equations;
  evaluate(group, equations);
  T m[6][7];
  for (std::size_t n = 0; n < 6; ++n) {
    const std::size_t i = n % 3;
    const T* direction = n < 3 ? equations.rod[i] : group.limb[i].axis;
    T* row = m[pose_.row[n]];
    for (int k = 0; k < 3; ++k) row[k] = direction[k];
    simd::cross(equations.joint[i], direction, row + 3);
    row[6] = -equations.value[n];
  }
  T x[6];
  const Mask regular = eliminate(m, x);
  T size(0.0);
  for (int k = 0; k < 6; ++k) {
    step[(k + 3) % 6] = x[k];
    size = size + abs(x[k]);
  }
  return regular & (size < T(kLargestStep));
}

}  // namespace poesy::three_prs
