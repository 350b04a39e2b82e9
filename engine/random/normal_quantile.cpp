#include "engine/random/normal_quantile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

#include "engine/base/contract.h"
#include "engine/base/instruction_sets.h"
#include "engine/random/stream.h"

namespace poesy {
namespace {

// Double arithmetic is exact enough here and much faster than Boost's default of long double.
using DoublePolicy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

// The bodies of the loops below are always inlined, because a call prevents vectorisation.

/// c[0] + c[1] x + ... + c[n-1] x^(n-1).
template <std::size_t n>
[[gnu::always_inline]] inline double polynomial(const double (&c)[n], double x) {
  double sum = c[n - 1];
  for (std::size_t k = n - 1; k-- > 0;) sum = sum * x + c[k];
  return sum;
}

constexpr double kMiddle = 0.425;

/// The quantile of the standard normal at the share 1/2 + q with |q| <= kMiddle, computed without a logarithm (Wichura
/// 1988, Appl. Stat. 37, 477-484, algorithm AS 241, PPND16). The relative error is about 1e-16.
[[gnu::always_inline]] inline double middle_quantile(double q) {
  constexpr double kAbove[] = {3.3871328727963666080,   1.3314166789178437745e2, 1.9715909503065514427e3,
                               1.3731693765509461125e4, 4.5921953931549871457e4, 6.7265770927008700853e4,
                               3.3430575583588128105e4, 2.5090809287301226727e3};
  constexpr double kBelow[] = {1.0000000000000000000,   4.2313330701600911252e1, 6.8718700749205790830e2,
                               5.3941960214247511077e3, 2.1213794301586595867e4, 3.9307895800092710610e4,
                               2.8729085735721942674e4, 5.2264952788528545610e3};
  const double r = kMiddle * kMiddle - q * q;
  return q * polynomial(kAbove, r) / polynomial(kBelow, r);
}

/// -log(t) for t < 1 that is not subnormal, within 1 unit in the last place: the range reduction and the polynomials of
/// fdlibm (Sun Microsystems 1993), without a branch.
[[gnu::always_inline]] inline double minus_log(double t) {
  // t = 2^e (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)).
  constexpr std::uint64_t kRootHalf = std::bit_cast<std::uint64_t>(std::numbers::sqrt2 / 2.0);
  constexpr std::uint64_t kOne = std::bit_cast<std::uint64_t>(1.0);
  constexpr std::uint64_t kFraction = (std::uint64_t{1} << 52) - 1;
  const std::uint64_t shifted = std::bit_cast<std::uint64_t>(t) + (kOne - kRootHalf);
  const double f = std::bit_cast<double>((shifted & kFraction) + kRootHalf) - 1.0;
  const double e = std::bit_cast<double>(shifted >> 52 | std::bit_cast<std::uint64_t>(0x1p52)) - (0x1p52 + 1023.0);
  constexpr double kOdd[] = {6.666666666666735130e-01, 2.857142874366239149e-01, 1.818357216161805012e-01,
                             1.479819860511658591e-01};
  constexpr double kEven[] = {3.999999999940941908e-01, 2.222219843214978396e-01, 1.531383769920937332e-01};
  constexpr double kLog2High = 6.93147180369123816490e-01;  // the first 33 bits of log(2)
  constexpr double kLog2Low = 1.90821492927058770002e-10;   // remaining bits of log(2)
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double w = z * z;
  const double series = w * polynomial(kEven, w) + z * polynomial(kOdd, w);
  const double half_square = 0.5 * f * f;
  return (half_square - (s * (half_square + series) + e * kLog2Low)) - f - e * kLog2High;
}

/// The distance from zero beyond which a share t of the standard normal lies on one side, for t between
/// kSmallestUniform and 1/2 - kMiddle. The distance is r - c(r), where r = sqrt(-2 log t) is the leading term for small
/// t. c is a rational function, fitted by weighted linear least squares with an iterated denominator. The fitted values
/// are the exact distances to 50 digits at the Chebyshev nodes of the range. The relative error of the fit is 4e-18.
[[gnu::always_inline]] inline double tail_quantile(double t) {
  constexpr double kAbove[] = {3.5870056229663754,  28.937060576976233,    44.18431979367937,
                               21.389873044820888,  5.5398569809415354,    0.7424741169485692,
                               0.03717765231554075, 0.0004690709722730646, 2.4116804079975693e-07};
  constexpr double kBelow[] = {1.0000000000000000,  12.721341502573727,  31.373094214925754,
                               25.55359771587685,   9.371477584658143,   1.9693262219575465,
                               0.20379222067285716, 0.00774446457838875, 7.09209541435361e-05};
  const double r = std::sqrt(2.0 * minus_log(t));
  return r - polynomial(kAbove, r) / polynomial(kBelow, r);
}

/// A normal about zero that may be truncated at +-half_width. Its quantile at u is the quantile of the whole normal at
/// 1/2 + middle(u); the share of the whole normal beyond this quantile, on its side of zero, is tail(u). For a drawn u
/// (a multiple of 2^-54, see stream.h), u - 1/2 and, for u >= 1/2, 1 - u are exact, so the quantiles at u and 1 - u are
/// exactly opposite.
struct Normal {
  double sigma;
  double half_width = std::numeric_limits<double>::infinity();
  double inside = 1.0;       ///< share of the whole normal within +-half_width
  double beyond_each = 0.0;  ///< share of the whole normal beyond each end

  [[gnu::always_inline]] double middle(double u) const { return (u - 0.5) * inside; }
  [[gnu::always_inline]] double tail(double u) const { return beyond_each + std::min(u, 1.0 - u) * inside; }
  [[gnu::always_inline]] bool is_middle(double u) const { return std::abs(middle(u)) <= kMiddle; }

  /// The quantile at u, if is_middle(u).
  [[gnu::always_inline]] double middle_value(double u) const {
    return std::clamp(sigma * middle_quantile(middle(u)), -half_width, half_width);
  }
  /// The quantile at u if is_middle(u) is false. distance: tail_quantile(tail(u)).
  [[gnu::always_inline]] double tail_value(double u, double distance) const {
    return std::copysign(std::min(sigma * distance, half_width), u - 0.5);
  }
};

Normal truncated(double sigma, double half_width) {
  const double cut = half_width / sigma / std::numbers::sqrt2;
  return {sigma, half_width, std::erf(cut), 0.5 * std::erfc(cut)};
}

double quantile_of(const Normal& normal, double u) {
  POESY_EXPECTS(u > 0.0 && u < 1.0);
  if (normal.is_middle(u)) return normal.middle_value(u);
  const double tail = normal.tail(u);
  if (tail >= kSmallestUniform) return normal.tail_value(u, tail_quantile(tail));
  return normal.tail_value(u, std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * tail, DoublePolicy{}));
}

/// Replaces shares in the middle (is_middle()) by their quantiles. Other shares get meaningless values.
POESY_EACH_INSTRUCTION_SET void replace_middles(Normal normal, double* shares, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) shares[k] = normal.middle_value(shares[k]);
}

/// Replaces shares outside the middle by their quantiles. Precondition: tails are not below kSmallestUniform.
POESY_EACH_INSTRUCTION_SET void replace_tails(Normal normal, double* shares, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k)
    shares[k] = normal.tail_value(shares[k], tail_quantile(normal.tail(shares[k])));
}

constexpr std::size_t kMask = 64;

constexpr std::array<std::uint64_t, kMask> kBits = [] {
  std::array<std::uint64_t, kMask> bits{};
  for (std::size_t k = 0; k < kMask; ++k) bits[k] = std::uint64_t{1} << k;
  return bits;
}();

/// Marks the shares outside the middle: bit k of masks[n] is 1 if shares[64 n + k] is outside.
POESY_EACH_INSTRUCTION_SET void mark_tails(Normal normal, const double* shares, std::size_t count,
                                           std::uint64_t* masks) {
  for (std::size_t begin = 0; begin < count; begin += kMask) {
    std::uint64_t mask = 0;
    for (std::size_t k = 0; k < std::min(kMask, count - begin); ++k) {
      mask |= normal.is_middle(shares[begin + k]) ? 0 : kBits[k];
    }
    *masks++ = mask;
  }
}

void replace_by_quantiles(const Normal& normal, std::span<double> shares) {
  constexpr std::size_t kBlock = 8 * kMask;
  std::array<std::uint64_t, kBlock / kMask> masks;
  std::array<std::uint16_t, kBlock> places;
  std::array<double, kBlock> tails;
  for (; !shares.empty(); shares = shares.subspan(std::min(kBlock, shares.size()))) {
    const std::span block = shares.first(std::min(kBlock, shares.size()));
    mark_tails(normal, block.data(), block.size(), masks.data());
    std::size_t count = 0;
    double smallest = 1.0;
    for (std::size_t begin = 0; begin < block.size(); begin += kMask) {
      for (std::uint64_t mask = masks[begin / kMask]; mask != 0; mask &= mask - 1) {
        const std::size_t place = begin + static_cast<std::size_t>(std::countr_zero(mask));
        places[count] = static_cast<std::uint16_t>(place);
        tails[count++] = block[place];
        smallest = std::min(smallest, block[place]);
      }
    }
    if (smallest < kSmallestUniform) {
      for (double& u : block) u = quantile_of(normal, u);
      continue;
    }
    replace_tails(normal, tails.data(), count);
    replace_middles(normal, block.data(), block.size());
    for (std::size_t n = 0; n < count; ++n) block[places[n]] = tails[n];
  }
}

}  // namespace

double normal_quantile(double sigma, double u) { return quantile_of({sigma}, u); }

void normal_quantiles(double sigma, std::span<double> shares) { replace_by_quantiles({sigma}, shares); }

double truncated_normal_quantile(double sigma, double half_width, double u) {
  return quantile_of(truncated(sigma, half_width), u);
}

void truncated_normal_quantiles(double sigma, double half_width, std::span<double> shares) {
  replace_by_quantiles(truncated(sigma, half_width), shares);
}

}  // namespace poesy
