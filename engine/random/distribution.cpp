#include "engine/random/distribution.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "engine/base/contract.h"
#include "engine/base/instruction_sets.h"
#include "engine/random/normal_quantile.h"

namespace poesy {

namespace {

// Every distribution here is symmetric, so a quantile functor maps the tail share t = min(u, 1 - u), 0 < t <= 1/2,
// to the distance from zero. 1 - u is exact for u >= 1/2, so both tails get the same precision and the same numbers.

// Double arithmetic is exact enough here and much faster than Boost's default of long double.
using DoublePolicy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

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
  switch (shape_) {
    case Shape::normal:
      return normal_quantile(sigma_, u);
    case Shape::truncated_normal:
      return quantile_of(TruncatedNormalTail(sigma_, half_width_), u);
    case Shape::uniform:
      return quantile_of(UniformTail{half_width_}, u);
    case Shape::triangular:
      return quantile_of(TriangularTail{half_width_}, u);
  }
  throw std::logic_error("unknown shape of distribution");
}

void Distribution::transform(std::span<double> uniforms) const {
  switch (shape_) {
    case Shape::normal:
      return normal_quantiles(sigma_, uniforms);
    case Shape::truncated_normal:
      return replace_by_quantiles(TruncatedNormalTail(sigma_, half_width_), uniforms);
    case Shape::uniform:
      return uniform_quantiles(half_width_, uniforms);
    case Shape::triangular:
      return triangular_quantiles(half_width_, uniforms);
  }
  throw std::logic_error("unknown shape of distribution");
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
