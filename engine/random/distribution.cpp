#include "engine/random/distribution.h"

#include <algorithm>
#include <array>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "engine/base/contract.h"

namespace poesy {

namespace {

// Every distribution here is symmetric, so a quantile functor maps the tail share t = min(u, 1 - u), 0 < t <= 1/2,
// to the distance from zero. 1 - u is exact for u >= 1/2, so both tails get the same precision and the same numbers.

// Double arithmetic is exact enough here and much faster than Boost's default of long double.
using DoublePolicy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

constexpr double kNormalMiddle = 0.425;

/// Quantile of the standard normal for a share 1/2 + q with |q| <= kNormalMiddle, without a logarithm: Wichura 1988,
/// Appl. Stat. 37, 477-484, algorithm AS 241, PPND16, within about 1e-16 of the value.
double normal_middle(double q) {
  constexpr double kCentre = 0.180625;  // 0.425^2
  const double r = kCentre - q * q;
  const double above =
      (((((((2.5090809287301226727e3 * r + 3.3430575583588128105e4) * r + 6.7265770927008700853e4) * r +
           4.5921953931549871457e4) *
              r +
          1.3731693765509461125e4) *
             r +
         1.9715909503065514427e3) *
            r +
        1.3314166789178437745e2) *
           r +
       3.3871328727963666080);
  const double below =
      (((((((5.2264952788528545610e3 * r + 2.8729085735721942674e4) * r + 3.9307895800092710610e4) * r +
           2.1213794301586595867e4) *
              r +
          5.3941960214247511077e3) *
             r +
         6.8718700749205790830e2) *
            r +
        4.2313330701600911252e1) *
           r +
       1.0);
  return q * above / below;
}

struct NormalTail {
  double sigma;

  double operator()(double t) const {
    const double q = 0.5 - t;
    if (q <= kNormalMiddle) return sigma * normal_middle(q);
    return sigma * (std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * t, DoublePolicy{}));
  }
};

struct TruncatedNormalTail {
  TruncatedNormalTail(double parent_sigma, double cut)
      : sigma(parent_sigma),
        half_width(cut),
        inside(std::erf(cut / parent_sigma / std::numbers::sqrt2)),
        outside(std::erfc(cut / parent_sigma / std::numbers::sqrt2)) {}

  double operator()(double t) const {
    // The parent normal's mass within the distance sought, or beyond it: whichever is the smaller keeps its digits.
    const double within = (1.0 - 2.0 * t) * inside;
    const double root = within <= 0.5 ? boost::math::erf_inv(within, DoublePolicy{})
                                      : boost::math::erfc_inv(outside + 2.0 * t * inside, DoublePolicy{});
    return std::min(sigma * (std::numbers::sqrt2 * root), half_width);
  }

  double sigma;
  double half_width;
  double inside;   ///< share of the parent normal within +-half_width
  double outside;  ///< share beyond
};

struct UniformTail {
  double half_width;

  double operator()(double t) const { return half_width * (1.0 - 2.0 * t); }
};

struct TriangularTail {
  double half_width;

  /// half_width (1 - sqrt(2 t)), written without the cancellation near the middle.
  double operator()(double t) const { return half_width * ((1.0 - 2.0 * t) / (1.0 + std::sqrt(2.0 * t))); }
};

template <class Tail>
double quantile_of(const Tail& tail, double u) {
  POESY_EXPECTS(u > 0.0 && u < 1.0);
  return u < 0.5 ? -tail(u) : tail(1.0 - u);
}

// A copy of the function for each instruction set, chosen when the program is loaded; without contraction of
// multiply-adds (see engine/CMakeLists.txt) all give the same bits. Sanitizers do not get on with the choosing.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define POESY_EACH_INSTRUCTION_SET __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define POESY_EACH_INSTRUCTION_SET
#endif

/// out[k] = normal_middle(uniforms[k] - 1/2), which is of use in the middle only.
POESY_EACH_INSTRUCTION_SET void normal_middles(const double* uniforms, double sigma, std::size_t count, double* out) {
  for (std::size_t k = 0; k < count; ++k) out[k] = sigma * normal_middle(uniforms[k] - 0.5);
}

/// As quantile_of for each, bit for bit: the middle of a block by vectors, then what lies in its tails one by one.
void normal_quantiles(double sigma, std::span<double> uniforms) {
  constexpr std::size_t kBlock = 256;
  std::array<double, kBlock> middles;
  std::array<std::uint16_t, kBlock> tails;
  for (; !uniforms.empty(); uniforms = uniforms.subspan(std::min(kBlock, uniforms.size()))) {
    const std::span block = uniforms.first(std::min(kBlock, uniforms.size()));
    normal_middles(block.data(), sigma, block.size(), middles.data());
    std::size_t count = 0;
    for (std::size_t k = 0; k < block.size(); ++k) {
      tails[count] = static_cast<std::uint16_t>(k);
      count += std::abs(block[k] - 0.5) <= kNormalMiddle ? 0 : 1;
    }
    for (std::size_t n = 0; n < count; ++n) middles[tails[n]] = quantile_of(NormalTail{sigma}, block[tails[n]]);
    std::copy_n(middles.begin(), block.size(), block.begin());
  }
}

/// Calls visit with the quantile functor of a distribution.
template <class Visit>
auto with_tail(const Distribution& distribution, const Visit& visit) {
  switch (distribution.shape()) {
    case Distribution::Shape::normal:
      return visit(NormalTail{distribution.sigma()});
    case Distribution::Shape::truncated_normal:
      return visit(TruncatedNormalTail(distribution.sigma(), distribution.half_width()));
    case Distribution::Shape::uniform:
      return visit(UniformTail{distribution.half_width()});
    case Distribution::Shape::triangular:
      return visit(TriangularTail{distribution.half_width()});
  }
  throw std::logic_error("unknown shape of distribution");
}

void expect_positive(const char* parameter, double value) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string(parameter) + " must be a finite number above zero");
  }
}

/// sigma sqrt(1 - 2 a phi(a) / (2 Phi(a) - 1)) with a = half_width / sigma.
double truncated_normal_deviation(double sigma, double half_width) {
  const double a = half_width / sigma;
  if (a >= 1.0) {
    const double density = std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi);
    return sigma * std::sqrt(1.0 - 2.0 * a * density / std::erf(a / std::numbers::sqrt2));
  }
  // Below, the difference cancels. With 2 Phi(a) - 1 = 2 a phi(a) (1 + a^2 T), T = sum over n >= 1 of
  // a^(2n-2) / (2n+1)!!, it equals a^2 T / (1 + a^2 T), a series of positive terms.
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

double Distribution::quantile(double u) const {
  return with_tail(*this, [u](const auto& tail) { return quantile_of(tail, u); });
}

void Distribution::transform(std::span<double> uniforms) const {
  if (shape_ == Shape::normal) return normal_quantiles(sigma_, uniforms);
  with_tail(*this, [uniforms](const auto& tail) {
    for (double& u : uniforms) u = quantile_of(tail, u);
  });
}

std::string_view name(Distribution::Shape shape) {
  switch (shape) {
    case Distribution::Shape::normal:
      return "normal";
    case Distribution::Shape::truncated_normal:
      return "truncated-normal";
    case Distribution::Shape::uniform:
      return "uniform";
    case Distribution::Shape::triangular:
      return "triangular";
  }
  throw std::logic_error("unknown shape of distribution");
}

}  // namespace poesy
