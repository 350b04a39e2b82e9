#pragma once

#include "models/simd/math.h"

// Vectors have 3 numbers. Rotation matrices have 9 numbers, row by row.

namespace poesy::simd {

/// The cross product c = a x b.
template <class T>
inline void cross(const T* a, const T* b, T* c) {
  c[0] = nmadd(a[2], b[1], a[1] * b[2]);
  c[1] = nmadd(a[0], b[2], a[2] * b[0]);
  c[2] = nmadd(a[1], b[0], a[0] * b[1]);
}

/// Adds a cross product: c += a x b.
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

// Taylor series in x = theta^2 of sin(theta) / theta, (1 - cos(theta)) / theta^2 and (theta - sin(theta)) / theta^3.
// The series are exact to rounding at the small angles for which the functions below use them.
inline constexpr double kSincSeries[] = {1.0,           -1.0 / 6.0,        1.0 / 120.0,        -1.0 / 5040.0,
                                         1.0 / 362880., -1.0 / 39916800.0, 1.0 / 6227020800.0, -1.0 / 1307674368000.0};
inline constexpr double kCoscSeries[] = {
    1.0 / 2.0,       -1.0 / 24.0,        1.0 / 720.0,         -1.0 / 40320.0,
    1.0 / 3628800.0, -1.0 / 479001600.0, 1.0 / 87178291200.0, -1.0 / 20922789888000.0};
inline constexpr double kCubeSeries[] = {
    1.0 / 6.0,        -1.0 / 120.0,        1.0 / 5040.0,          -1.0 / 362880.0,
    1.0 / 39916800.0, -1.0 / 6227020800.0, 1.0 / 1307674368000.0, -1.0 / 355687428096000.0};
/// Taylor series in theta^2 of (1 - theta/2 cot(theta/2)) / theta^2, used below 0.65 rad.
inline constexpr double kCotSeries[] = {1.0 / 12.0,
                                        1.0 / 720.0,
                                        1.0 / 30240.0,
                                        1.0 / 1209600.0,
                                        1.0 / 47900160.0,
                                        691.0 / 1307674368000.0,
                                        1.0 / 74724249600.0,
                                        3617.0 / 10670622842880000.0,
                                        43867.0 / 5109094217170944000.0};
/// Taylor series in t^2 of atan(t) / t, used for |t| <= 0.415, which includes tan(pi/8).
inline constexpr double kAtanSeries[] = {1.0,        -1.0 / 3.0,  1.0 / 5.0,  -1.0 / 7.0,  1.0 / 9.0,  -1.0 / 11.0,
                                         1.0 / 13.0, -1.0 / 15.0, 1.0 / 17.0, -1.0 / 19.0, 1.0 / 21.0, -1.0 / 23.0,
                                         1.0 / 25.0, -1.0 / 27.0, 1.0 / 29.0, -1.0 / 31.0, 1.0 / 33.0, -1.0 / 35.0,
                                         1.0 / 37.0, -1.0 / 39.0, 1.0 / 41.0, -1.0 / 43.0};
/// The first terms of kAtanSeries, used for |t| <= 0.335.
inline constexpr double kAtanShort[] = {1.0,        -1.0 / 3.0,  1.0 / 5.0,  -1.0 / 7.0,  1.0 / 9.0,  -1.0 / 11.0,
                                        1.0 / 13.0, -1.0 / 15.0, 1.0 / 17.0, -1.0 / 19.0, 1.0 / 21.0, -1.0 / 23.0,
                                        1.0 / 25.0, -1.0 / 27.0, 1.0 / 29.0, -1.0 / 31.0, 1.0 / 33.0};

/// The coefficients of exp(w) = I + a hat(w) + b hat(w)^2 at the angle theta = |w|.
template <class T>
struct ExpCoefficients {
  T a;  ///< sin(theta) / theta
  T b;  ///< (1 - cos(theta)) / theta^2
};

/// The coefficients of exp as functions of theta^2, for theta < 100.
template <class T>
inline ExpCoefficients<T> exp_coefficients(T theta_squared) {
  const T x = theta_squared;
  ExpCoefficients<T> c{polynomial(x, kSincSeries), polynomial(x, kCoscSeries)};
  const auto large = x > T(0.25);
  if (any(large)) {
    const T safe = select(large, x, T(1.0));
    const T theta = sqrt(safe);
    const auto [sine, cosine] = sin_cos(theta);
    c.a = select(large, sine / theta, c.a);
    c.b = select(large, (T(1.0) - cosine) / safe, c.b);
  }
  return c;
}

/// The coefficients of left_jacobian(w) = I + b hat(w) + c hat(w)^2 at the angle theta = |w|.
template <class T>
struct LeftJacobianCoefficients {
  T b;  ///< (1 - cos(theta)) / theta^2
  T c;  ///< (theta - sin(theta)) / theta^3
};

/// The coefficients of the left Jacobian as functions of theta^2, for theta < 100.
template <class T>
inline LeftJacobianCoefficients<T> left_jacobian_coefficients(T theta_squared) {
  const T x = theta_squared;
  LeftJacobianCoefficients<T> coefficients{polynomial(x, kCoscSeries), polynomial(x, kCubeSeries)};
  const auto large = x > T(0.25);
  if (any(large)) {
    const T safe = select(large, x, T(1.0));
    const T theta = sqrt(safe);
    const auto [sine, cosine] = sin_cos(theta);
    coefficients.b = select(large, (T(1.0) - cosine) / safe, coefficients.b);
    coefficients.c = select(large, (theta - sine) / (safe * theta), coefficients.c);
  }
  return coefficients;
}

/// Sets r to the rotation matrix exp(w). theta_squared: |w|^2. c: exp_coefficients(theta_squared); if the sign of `c.a`
/// is reversed, r becomes the inverse matrix.
template <class T>
inline void rotation_matrix(const T* w, T theta_squared, const ExpCoefficients<T>& c, T* r) {
  // R = (1 - b theta^2) I + a hat(w) + b w w^T
  const T diagonal = nmadd(c.b, theta_squared, T(1.0));
  for (int row = 0; row < 3; ++row) {
    const T scaled = c.b * w[row];
    for (int column = 0; column < 3; ++column) r[3 * row + column] = scaled * w[column];
    r[4 * row] = r[4 * row] + diagonal;
  }
  r[1] = nmadd(c.a, w[2], r[1]);
  r[2] = madd(c.a, w[1], r[2]);
  r[3] = madd(c.a, w[2], r[3]);
  r[5] = nmadd(c.a, w[0], r[5]);
  r[6] = nmadd(c.a, w[1], r[6]);
  r[7] = madd(c.a, w[0], r[7]);
}

/// The rotation vector w of a rotation by the angle theta = |w|, and a coefficient of the inverse left Jacobian.
template <class T>
struct RotationLog {
  T w[3];  ///< components x, y, z
  T bend;  ///< (1 - theta/2 cot(theta/2)) / theta^2: left_jacobian(w)^-1 = I - hat(w) / 2 + bend hat(w)^2
};

/// The logarithm of rotations by less than 180 deg. The angle theta is computed from tan(theta/2) = sin(theta) / (1 +
/// cos(theta)), which loses no digits at the small angles of residuals; beyond 37 deg it is computed from tan(theta/8).
/// The result loses digits close to 180 deg.
template <class T>
inline RotationLog<T> rotation_log(const T* r) {
  const T half(0.5);
  const T a[3] = {half * (r[7] - r[5]), half * (r[2] - r[6]), half * (r[3] - r[1])};
  const T sine2 = dot3(a, a);
  const T cosine = half * (r[0] + r[4] + r[8] - T(1.0));
  const T denominator = T(1.0) / (T(1.0) + cosine);
  const T tan2 = sine2 * denominator * denominator;
  T factor = (denominator + denominator) * polynomial(tan2, kAtanShort);  // theta / sin(theta)
  T theta2 = factor * factor * sine2;
  T bend = polynomial(theta2, kCotSeries);
  const auto wide = !(tan2 < T(0.1111));
  if (any(wide)) {
    const T half_tan = sqrt(select(wide, tan2, T(1.0)));
    const T quarter = half_tan / (T(1.0) + sqrt(madd(half_tan, half_tan, T(1.0))));
    const T eighth = quarter / (T(1.0) + sqrt(madd(quarter, quarter, T(1.0))));
    const T theta = T(8.0) * eighth * polynomial(eighth * eighth, kAtanSeries);
    factor = select(wide, theta / sqrt(select(wide, sine2, T(1.0))), factor);
    theta2 = select(wide, theta * theta, theta2);
    bend = select(wide, (T(1.0) - half * theta / half_tan) / (theta * theta), bend);
  }
  return {{factor * a[0], factor * a[1], factor * a[2]}, bend};
}

}  // namespace poesy::simd
