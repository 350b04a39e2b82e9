#pragma once

#include <cstddef>

namespace poesy::simd {

/// The polynomial c[0] + c[1] x + ... + c[n-1] x^(n-1).
template <class T, std::size_t n>
inline T polynomial(T x, const double (&c)[n]) {
  T sum = c[n - 1];
  for (std::size_t k = n - 1; k-- > 0;) sum = madd(sum, x, T(c[k]));
  return sum;
}

/// Sine and cosine of one angle.
template <class T>
struct SinCos {
  T sin;  ///< sine of the angle
  T cos;  ///< cosine of the angle
};

/// Sine and cosine for |x| <= pi/4 by the polynomials of fdlibm (Sun Microsystems 1993).
template <class T>
inline SinCos<T> sin_cos_near_zero(T x) {
  static constexpr double kSin[] = {-1.66666666666666324348e-01, 8.33333333332248946124e-03,
                                    -1.98412698298579493134e-04, 2.75573137070700676789e-06,
                                    -2.50507602534068634195e-08, 1.58969099521155010221e-10};
  static constexpr double kCos[] = {4.16666666666666019037e-02, -1.38888888888741095749e-03,
                                    2.48015872894767294178e-05, -2.75573143513906633035e-07,
                                    2.08757232129817482790e-09, -1.13596475577881948265e-11};
  const T z = x * x;
  return {madd(x * z, polynomial(z, kSin), x), madd(z * z, polynomial(z, kCos), nmadd(T(0.5), z, T(1.0)))};
}

/// Sine and cosine for |x| < 100, within 2 ulp (units in the last place), except near a zero at n pi/2 (n not 0), where
/// the absolute error is at most 1e-26 |n|. The reduction by multiples of pi/2 uses pi/2 in two parts (Cody and Waite).
/// This reduction is skipped if no lane needs it; the results are the same to the last bit.
template <class T>
inline SinCos<T> sin_cos(T x) {
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr double kHalfPiHigh = 1.57079632673412561417e+00;  // the first 33 bits of pi/2
  constexpr double kHalfPiLow = 6.07710050650619224932e-11;   // the next bits of pi/2
  const T quarters = x * T(kTwoOverPi);
  if (!any(!(abs(quarters) < T(0.5)))) return sin_cos_near_zero(x);
  const T n = nearest(quarters);
  const auto [sine, cosine] = sin_cos_near_zero(nmadd(n, T(kHalfPiLow), nmadd(n, T(kHalfPiHigh), x)));
  // n mod 2 as 0 or +-1, and n mod 4 as -2 .. 2.
  const T odd = nmadd(T(2.0), nearest(T(0.5) * n), n);
  const T quarter = nmadd(T(4.0), nearest(T(0.25) * n), n);
  const auto swap = abs(odd) > T(0.5);
  const auto sine_negative = (abs(quarter) > T(1.5)) | (quarter < T(-0.5));
  const auto cosine_negative = (abs(quarter) > T(1.5)) | (quarter > T(0.5));
  const T s = select(swap, cosine, sine);
  const T c = select(swap, sine, cosine);
  return {select(sine_negative, -s, s), select(cosine_negative, -c, c)};
}

}  // namespace poesy::simd
