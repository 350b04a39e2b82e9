#include "engine/random/distribution.h"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/instruction_sets.h"
#include "engine/random/normal_share.h"

namespace poesy {

namespace {

// Double arithmetic is exact enough here and much faster than Boost's default of long double.
using DoublePolicy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

// The bodies of the loops below are always inlined, because a call prevents vectorisation.

/// c[0] + c[1] x + ... + c[n-1] x^(n-1)
template <std::size_t n>
[[gnu::always_inline]] inline double polynomial(const double (&c)[n], double x) {
  double sum = c[n - 1];
  for (std::size_t k = n - 1; k-- > 0;) sum = sum * x + c[k];
  return sum;
}

constexpr double kMiddle = 0.425;

/// Quantile of the standard normal for a share 1/2 + q with |q| <= kMiddle, without a logarithm: Wichura 1988,
/// Appl. Stat. 37, 477-484, algorithm AS 241, PPND16, within about 1e-16 of the value.
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

/// -log(t) for normal t < 1, within 1 ulp: the reduction and the polynomials of fdlibm (Sun Microsystems 1993), without
/// a branch.
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
  constexpr double kLog2Low = 1.90821492927058770002e-10;   // the rest
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double w = z * z;
  const double series = w * polynomial(kEven, w) + z * polynomial(kOdd, w);
  const double half_square = 0.5 * f * f;
  return (half_square - (s * (half_square + series) + e * kLog2Low)) - f - e * kLog2High;
}

/// The smallest share that a stream draws, see uniform_from_bits.
constexpr double kSmallestDraw = 0x1p-54;

/// The distance from zero beyond which a share t lies, kSmallestDraw <= t <= 1/2 - kMiddle. It is r - c(r) with r =
/// sqrt(-2 log t), the leading term for small t. c is a rational function fitted to the inverse with 50 digits
/// (Newton's iteration at the Chebyshev nodes of the range) by weighted linear least squares with an iterated
/// denominator. Its error is 4e-18 of the value.
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

[[gnu::always_inline]] inline bool in_middle(double u) { return std::abs(u - 0.5) <= kMiddle; }

/// The share beyond the value, on its side of zero. 1 - u is exact for u >= 1/2.
[[gnu::always_inline]] inline double beyond(double u) { return std::min(u, 1.0 - u); }

/// Quantile of the standard normal outside the middle.
[[gnu::always_inline]] inline double signed_tail(double u) { return std::copysign(tail_quantile(beyond(u)), u - 0.5); }

/// The same as signed_tail() for shares that no stream draws.
double signed_extreme(double u) {
  const double root = boost::math::erfc_inv(2.0 * beyond(u), DoublePolicy{});
  return std::copysign(std::numbers::sqrt2 * root, u - 0.5);
}

/// Exact for shares in the middle; other shares get meaningless values.
POESY_EACH_INSTRUCTION_SET void replace_middles(double sigma, double* shares, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) shares[k] = sigma * middle_quantile(shares[k] - 0.5);
}

/// Exact for shares outside the middle and not below kSmallestDraw.
POESY_EACH_INSTRUCTION_SET void replace_tails(double sigma, double* shares, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) shares[k] = sigma * signed_tail(shares[k]);
}

constexpr std::size_t kMask = 64;

constexpr std::array<std::uint64_t, kMask> kBits = [] {
  std::array<std::uint64_t, kMask> bits{};
  for (std::size_t k = 0; k < kMask; ++k) bits[k] = std::uint64_t{1} << k;
  return bits;
}();

/// Bit k of mask n is set if share 64 n + k, of `count`, is outside the middle.
POESY_EACH_INSTRUCTION_SET void mark_tails(const double* shares, std::size_t count, std::uint64_t* masks) {
  for (std::size_t begin = 0; begin < count; begin += kMask) {
    std::uint64_t mask = 0;
    for (std::size_t k = 0; k < std::min(kMask, count - begin); ++k) {
      mask |= in_middle(shares[begin + k]) ? 0 : kBits[k];
    }
    *masks++ = mask;
  }
}

// Every shape but the measured one is symmetric. So a quantile functor maps the tail share t = min(u, 1 - u), 0 < t <=
// 1/2, to the distance from zero. 1 - u is exact for u >= 1/2, so both tails have the same precision and the same
// numbers.

struct TruncatedNormalTail {
  TruncatedNormalTail(double parent_sigma, double cut)
      : sigma(parent_sigma),
        half_width(cut),
        inside(std::erf(cut / parent_sigma / std::numbers::sqrt2)),
        outside(std::erfc(cut / parent_sigma / std::numbers::sqrt2)) {}

  double operator()(double t) const {
    // The parent normal's share within the distance, or beyond it: the smaller one is used, because it keeps its
    // digits.
    const double within = (1.0 - 2.0 * t) * inside;
    const double root = within <= 0.5 ? boost::math::erf_inv(within, DoublePolicy{})
                                      : boost::math::erfc_inv(outside + 2.0 * t * inside, DoublePolicy{});
    return std::min(sigma * (std::numbers::sqrt2 * root), half_width);
  }

  double sigma;
  double half_width;
  double inside;   ///< share of the parent normal within +-half_width
  double outside;  ///< share beyond half_width
};

struct UniformTail {
  double half_width;

  double operator()(double t) const { return half_width * (1.0 - 2.0 * t); }
};

struct TriangularTail {
  double half_width;

  /// half_width (1 - sqrt(2 t)), without the cancellation near the middle.
  double operator()(double t) const { return half_width * ((1.0 - 2.0 * t) / (1.0 + std::sqrt(2.0 * t))); }
};

template <class Tail>
double quantile_of(const Tail& tail, double u) {
  POESY_EXPECTS(u > 0.0 && u < 1.0);
  return std::copysign(tail(std::min(u, 1.0 - u)), u - 0.5);
}

template <class Tail>
void replace_by_quantiles(const Tail& tail, std::span<double> uniforms) {
  for (double& u : uniforms) u = quantile_of(tail, u);
}

POESY_EACH_INSTRUCTION_SET void uniform_quantiles(double half_width, std::span<double> uniforms) {
  replace_by_quantiles(UniformTail{half_width}, uniforms);
}

POESY_EACH_INSTRUCTION_SET void triangular_quantiles(double half_width, std::span<double> uniforms) {
  replace_by_quantiles(TriangularTail{half_width}, uniforms);
}

/// The position of a share within its half of a shifted distribution, strictly inside (0, 1). 2u and 2u - 1 are exact.
[[gnu::always_inline]] inline double share_in_half(double u) {
  return u < 0.5 ? 2.0 * u : std::max(2.0 * u - 1.0, kSmallestDraw);
}

/// The shift of the half in which a share lies.
[[gnu::always_inline]] inline double shift_of_half(double shift, double u) { return std::copysign(shift, u - 0.5); }

bool is_symmetric(Distribution::Shape shape) {
  return shape != Distribution::Shape::measured && shape != Distribution::Shape::given;
}

/// The value of a share u, of values that are equally likely.
double value_of_share(std::span<const double> values, double u) {
  const auto place = static_cast<std::size_t>(u * static_cast<double>(values.size()));
  return values[std::min(place, values.size() - 1)];
}

void expect_positive(const char* parameter, double value) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string(parameter) + " must be a finite number above zero");
  }
}

void expect_values(std::span<const double> values, std::size_t least_number) {
  if (values.size() < least_number) {
    throw std::invalid_argument("values must be at least " + std::to_string(least_number) + ", not " +
                                std::to_string(values.size()));
  }
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
    throw std::invalid_argument("values must be finite numbers");
  }
  const auto [least, greatest] = std::ranges::minmax(values);
  if (least == greatest) throw std::invalid_argument("values must not all be equal");
}

/// sigma sqrt(1 - 2 a phi(a) / (2 Phi(a) - 1)) with a = half_width / sigma.
double truncated_normal_deviation(double sigma, double half_width) {
  const double a = half_width / sigma;
  if (a >= 1.0) {
    const double density = std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi);
    return sigma * std::sqrt(1.0 - 2.0 * a * density / std::erf(a / std::numbers::sqrt2));
  }
  // For smaller a the difference cancels. With 2 Phi(a) - 1 = 2 a phi(a) (1 + a^2 T), T = sum over n >= 1 of a^(2n-2) /
  // (2n+1)!!, it equals a^2 T / (1 + a^2 T), a series of positive terms.
  const double a2 = a * a;
  double sum = 0.0;
  double term = 1.0 / 3.0;
  for (double odd = 5.0; sum + term != sum; odd += 2.0) {
    sum += term;
    term *= a2 / odd;
  }
  return half_width * std::sqrt(sum / (1.0 + a2 * sum));
}

}  // namespace

double normal_quantile(double sigma, double u) {
  POESY_EXPECTS(u > 0.0 && u < 1.0);
  if (in_middle(u)) return sigma * middle_quantile(u - 0.5);
  return sigma * (beyond(u) < kSmallestDraw ? signed_extreme(u) : signed_tail(u));
}

void normal_quantiles(double sigma, std::span<double> shares) {
  constexpr std::size_t kBlock = 8 * kMask;
  std::array<std::uint64_t, kBlock / kMask> masks;
  std::array<std::uint16_t, kBlock> places;
  std::array<double, kBlock> tails;
  for (; !shares.empty(); shares = shares.subspan(std::min(kBlock, shares.size()))) {
    const std::span block = shares.first(std::min(kBlock, shares.size()));
    mark_tails(block.data(), block.size(), masks.data());
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
    if (smallest < kSmallestDraw) {
      for (double& u : block) u = normal_quantile(sigma, u);
      continue;
    }
    replace_tails(sigma, tails.data(), count);
    replace_middles(sigma, block.data(), block.size());
    for (std::size_t n = 0; n < count; ++n) block[places[n]] = tails[n];
  }
}

Distribution::Distribution(Shape shape, double sigma, double half_width, double standard_deviation)
    : shape_(shape), sigma_(sigma), half_width_(half_width), standard_deviation_(standard_deviation) {}

Distribution Distribution::normal(double sigma) {
  expect_positive("sigma", sigma);
  return {Shape::normal, sigma, std::numeric_limits<double>::infinity(), sigma};
}

Distribution Distribution::truncated_normal(double sigma, double half_width) {
  expect_positive("sigma", sigma);
  expect_positive("half_width", half_width);
  return {Shape::truncated_normal, sigma, half_width, truncated_normal_deviation(sigma, half_width)};
}

Distribution Distribution::uniform(double half_width) {
  expect_positive("half_width", half_width);
  return {Shape::uniform, 0.0, half_width, half_width / std::numbers::sqrt3};
}

Distribution Distribution::triangular(double half_width) {
  expect_positive("half_width", half_width);
  return {Shape::triangular, 0.0, half_width, half_width / std::sqrt(6.0)};
}

Distribution Distribution::measured(std::vector<double> values) {
  expect_values(values, kLeastMeasured);
  SmoothedValues parts(std::move(values));
  Distribution made(Shape::measured, 0.0, std::max(std::abs(parts.least()), std::abs(parts.greatest())),
                    parts.standard_deviation());
  made.mean_ = parts.mean();
  made.parts_ = std::move(parts);
  return made;
}

Distribution Distribution::given(std::vector<double> values) {
  expect_values(values, 2);
  std::ranges::sort(values);
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double value : values) mean += value / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  Distribution made(Shape::given, 0.0, std::max(std::abs(values.front()), std::abs(values.back())),
                    std::sqrt(squares / (n - 1.0)));
  made.mean_ = mean;
  made.given_ = std::move(values);
  return made;
}

Distribution Distribution::shifted(double shift) const {
  POESY_EXPECTS(shift_ == 0.0);
  const double deviation = std::hypot(standard_deviation_, shift);
  if (!(shift >= 0.0) || !std::isfinite(deviation)) {
    throw std::invalid_argument("shift must be a finite number, not below zero");
  }
  if (!is_symmetric(shape_) && shift > 0.0) throw std::invalid_argument("shift is not for measured values");
  Distribution made = *this;
  if (shift == 0.0) return made;
  made.shift_ = shift;
  made.standard_deviation_ = deviation;
  return made;
}

Distribution Distribution::about(double centre) const {
  POESY_EXPECTS(centre_ == 0.0);
  if (!std::isfinite(centre)) throw std::invalid_argument("mean must be a finite number");
  if (!is_symmetric(shape_) && centre != 0.0) throw std::invalid_argument("mean is not for measured values");
  Distribution made = *this;
  if (centre == 0.0) return made;
  made.centre_ = centre;
  made.mean_ = centre;
  return made;
}

double Distribution::quantile(double u) const {
  POESY_EXPECTS(u > 0.0 && u < 1.0);
  double value = shift_ == 0.0 ? centred_quantile(u) : centred_quantile(share_in_half(u)) + shift_of_half(shift_, u);
  add_centre({&value, 1});
  return value;
}

void Distribution::add_centre(std::span<double> values) const {
  if (centre_ == 0.0) return;
  for (double& value : values) value += centre_;
}

double Distribution::centred_quantile(double u) const {
  switch (shape_) {
    case Shape::normal:
      return normal_quantile(sigma_, u);
    case Shape::truncated_normal:
      return quantile_of(TruncatedNormalTail(sigma_, half_width_), u);
    case Shape::uniform:
      return quantile_of(UniformTail{half_width_}, u);
    case Shape::triangular:
      return quantile_of(TriangularTail{half_width_}, u);
    case Shape::measured:
      return parts_->quantile(u);
    case Shape::given:
      return value_of_share(given_, u);
  }
  throw std::logic_error("unknown shape of distribution");
}

void Distribution::transform(std::span<double> uniforms) const {
  shifted_transform(uniforms);
  add_centre(uniforms);
}

void Distribution::shifted_transform(std::span<double> uniforms) const {
  if (shift_ == 0.0) return centred_transform(uniforms);
  std::array<double, 512> shifts;
  for (; !uniforms.empty(); uniforms = uniforms.subspan(std::min(shifts.size(), uniforms.size()))) {
    const std::span block = uniforms.first(std::min(shifts.size(), uniforms.size()));
    for (std::size_t k = 0; k < block.size(); ++k) {
      shifts[k] = shift_of_half(shift_, block[k]);
      block[k] = share_in_half(block[k]);
    }
    centred_transform(block);
    for (std::size_t k = 0; k < block.size(); ++k) block[k] += shifts[k];
  }
}

void Distribution::centred_transform(std::span<double> uniforms) const {
  switch (shape_) {
    case Shape::normal:
      return normal_quantiles(sigma_, uniforms);
    case Shape::truncated_normal:
      return replace_by_quantiles(TruncatedNormalTail(sigma_, half_width_), uniforms);
    case Shape::uniform:
      return uniform_quantiles(half_width_, uniforms);
    case Shape::triangular:
      return triangular_quantiles(half_width_, uniforms);
    case Shape::measured:
      for (double& u : uniforms) u = parts_->quantile(u);
      return;
    case Shape::given:
      for (double& u : uniforms) u = value_of_share(given_, u);
      return;
  }
  throw std::logic_error("unknown shape of distribution");
}

void Distribution::transform_scores(std::span<double> scores) const {
  if (shape_ == Shape::normal && shift_ == 0.0) {
    for (double& score : scores) score *= sigma_;
    add_centre(scores);
    return;
  }
  normal_shares(scores);
  transform(scores);
}

std::string_view name(Distribution::Shape shape) {
  using enum Distribution::Shape;
  switch (shape) {
    case normal:
      return "normal";
    case truncated_normal:
      return "truncated-normal";
    case uniform:
      return "uniform";
    case triangular:
      return "triangular";
    case measured:
      return "measured";
    case given:
      return "given";
  }
  throw std::logic_error("unknown shape of distribution");
}

}  // namespace poesy
