#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "models/lie/scalar.h"

namespace poesy::lie {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;

/// The matrix of the cross product: hat(w) x = w x x (Du et al. 2022, Eq. A3).
template <class T>
Matrix3<T> hat(const Vector3<T>& w) {
  Matrix3<T> m;
  m << T(0), -w.z(), w.y(), w.z(), T(0), -w.x(), -w.y(), w.x(), T(0);
  return m;
}

/// The vector of the antisymmetric part of m; the inverse of hat().
template <class T>
Vector3<T> vee(const Matrix3<T>& m) {
  return T(0.5) * Vector3<T>(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
}

/// Coefficients of exp and of its left Jacobian at the angle theta, accurate to rounding at every angle.
template <class T>
struct ExpCoefficients {
  T a;  ///< sin(theta)/theta
  T b;  ///< (1 - cos(theta))/theta^2
  T c;  ///< (theta - sin(theta))/theta^3
};

template <class T>
ExpCoefficients<T> exp_coefficients(T theta_squared) {
  using std::sin;
  using std::sqrt;
  const T x = theta_squared;
  // The closed forms lose digits to cancellation if theta^2 < 1/4. These series are exact to rounding there.
  const auto small = x < T(0.25);
  const T a_series =
      T(1) - x / T(6) *
                 (T(1) - x / T(20) *
                             (T(1) - x / T(42) *
                                         (T(1) - x / T(72) *
                                                     (T(1) - x / T(110) * (T(1) - x / T(156) * (T(1) - x / T(210)))))));
  const T half_b_series =
      T(1) - x / T(12) *
                 (T(1) - x / T(30) *
                             (T(1) - x / T(56) *
                                         (T(1) - x / T(90) *
                                                     (T(1) - x / T(132) * (T(1) - x / T(182) * (T(1) - x / T(240)))))));
  const T c_series =
      T(1) - x / T(20) *
                 (T(1) - x / T(42) *
                             (T(1) - x / T(72) *
                                         (T(1) - x / T(110) *
                                                     (T(1) - x / T(156) * (T(1) - x / T(210) * (T(1) - x / T(272)))))));
  const T safe = select(small, T(1), x);
  const T theta = sqrt(safe);
  const T sine = sin(theta);
  const T half_sine = sin(T(0.5) * theta);
  return {select(small, a_series, sine / theta),
          select(small, T(0.5) * half_b_series, T(2) * half_sine * half_sine / safe),
          select(small, c_series / T(6), (theta - sine) / (safe * theta))};
}

/// The rotation by the angle |w| about w (Du et al. 2022, Eq. A5), accurate at every angle.
template <class T>
Matrix3<T> exp(const Vector3<T>& w) {
  const auto [a, b, c] = exp_coefficients<T>(w.squaredNorm());
  static_cast<void>(c);
  const Matrix3<T> w_hat = hat(w);
  Matrix3<T> rotation = a * w_hat + b * (w_hat * w_hat);
  rotation.diagonal().array() += T(1);
  return rotation;
}

/// The displacement exp(w) x - x of a point by a rotation, without cancellation at small angles.
template <class T>
Vector3<T> moved_by_rotation(const Vector3<T>& w, const Vector3<T>& x) {
  const auto [a, b, c] = exp_coefficients<T>(w.squaredNorm());
  static_cast<void>(c);
  const Vector3<T> across = w.cross(x);
  return a * across + b * w.cross(across);
}

/// The left Jacobian V of SO(3) at w, for which exp([w; v]) = (exp(w), V v). V is Eq. A4 of Du et al. 2022 for a w of
/// any length.
template <class T>
Matrix3<T> left_jacobian(const Vector3<T>& w) {
  const auto [a, b, c] = exp_coefficients<T>(w.squaredNorm());
  static_cast<void>(a);
  const Matrix3<T> w_hat = hat(w);
  Matrix3<T> v = b * w_hat + c * (w_hat * w_hat);
  v.diagonal().array() += T(1);
  return v;
}

/// The inverse of left_jacobian(), for |w| < 2 pi.
template <class T>
Matrix3<T> left_jacobian_inverse(const Vector3<T>& w) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T x = w.squaredNorm();
  const auto small = x < T(0.25);
  // (1 - theta/2 cot(theta/2)) / theta^2 = sum of |B_2n| theta^(2n-2) / (2n)!, where B_2n are Bernoulli numbers.
  const T series =
      T(1) / T(12) +
      x * (T(1) / T(720) + x * (T(1) / T(30240) + x * (T(1) / T(1209600) +
                                                       x * (T(1) / T(47900160) + x * (T(691) / T(1307674368000) +
                                                                                      x * (T(1) / T(74724249600)))))));
  const T safe = select(small, T(1), x);
  const T half = T(0.5) * sqrt(safe);
  const T closed = (T(1) - half * cos(half) / sin(half)) / safe;
  const Matrix3<T> w_hat = hat(w);
  Matrix3<T> inverse = T(-0.5) * w_hat + select(small, series, closed) * (w_hat * w_hat);
  inverse.diagonal().array() += T(1);
  return inverse;
}

namespace detail {

/// The unit axis n of a rotation by more than 90 degrees, from the symmetric part S of the matrix, because the
/// antisymmetric part vanishes at 180 degrees. With the cosine c of the angle, n n^T (1 - c) = S - c I. The column with
/// the largest diagonal entry is the most accurate.
template <class T>
Vector3<T> axis_from_symmetric_part(const Matrix3<T>& rotation, T cosine, const Vector3<T>& antisymmetric) {
  using std::sqrt;
  const Matrix3<T> s = T(0.5) * (rotation + rotation.transpose());
  const auto y_over_x = s(1, 1) > s(0, 0);
  const T largest_xy = select(y_over_x, s(1, 1), s(0, 0));
  const auto z_over_xy = s(2, 2) > largest_xy;
  Vector3<T> axis;
  for (int k = 0; k < 3; ++k) {
    const T xy = select(y_over_x, s(k, 1) - (k == 1 ? cosine : T(0)), s(k, 0) - (k == 0 ? cosine : T(0)));
    axis[k] = select(z_over_xy, s(k, 2) - (k == 2 ? cosine : T(0)), xy);
  }
  const T sign = select(axis.dot(antisymmetric) < T(0), T(-1), T(1));
  return axis * (sign / sqrt(axis.squaredNorm()));
}

}  // namespace detail

/// The rotation vector w with exp(w) = rotation and |w| <= pi, accurate from 0 to pi. At pi the sign of w is arbitrary.
/// The result equals Eq. A6 of Du et al. 2022, except at the identity and at pi, where the printed equation is 0/0.
template <class T>
Vector3<T> log(const Matrix3<T>& rotation) {
  using std::atan2;
  using std::sqrt;
  const Vector3<T> antisymmetric = vee(rotation);  // n sin(theta) for the axis n and the angle theta
  const T sine = sqrt(antisymmetric.squaredNorm());
  const T cosine = T(0.5) * (rotation.trace() - T(1));
  const T theta = atan2(sine, cosine);
  const auto turning = sine > T(0);
  const T factor = select(turning, theta / select(turning, sine, T(1)), T(1));
  Vector3<T> w = factor * antisymmetric;
  const auto beyond = cosine < T(-0.5);
  if (any(beyond)) {
    const Vector3<T> axis = detail::axis_from_symmetric_part<T>(rotation, cosine, antisymmetric);
    for (int k = 0; k < 3; ++k) w[k] = select(beyond, T(theta * axis[k]), w[k]);
  }
  return w;
}

}  // namespace poesy::lie
