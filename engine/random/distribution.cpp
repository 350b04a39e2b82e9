#include "engine/random/distribution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/instruction_sets.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/normal_share.h"
#include "engine/random/stream.h"

namespace poesy {

namespace {

// Uniform and triangular shapes are symmetric. So their functors compute a quantile only for a share t = min(u, 1 - u)
// in a tail, 0 < t <= 1/2: they return the distance of the quantile from zero. 1 - u is exact for u >= 1/2, so both
// tails have the same precision and the same numbers.

struct UniformTail {
  double half_width;

  double operator()(double t) const { return half_width * (1.0 - 2.0 * t); }
};

struct TriangularTail {
  double half_width;

  /// The distance from zero of the quantile at the share t < 1/2: half_width (1 - sqrt(2 t)), without cancellation near
  /// the middle.
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

/// A shifted distribution has two halves, u < 1/2 and u >= 1/2. Returns the share of a draw u within its half, strictly
/// inside (0, 1). 2u and 2u - 1 are exact.
[[gnu::always_inline]] inline double share_in_half(double u) {
  return u < 0.5 ? 2.0 * u : std::max(2.0 * u - 1.0, kSmallestUniform);
}

/// The shift of the half of a shifted distribution to which the share u belongs: -shift for u < 1/2, otherwise shift.
[[gnu::always_inline]] inline double shift_of_half(double shift, double u) { return std::copysign(shift, u - 0.5); }

bool is_symmetric(Distribution::Shape shape) {
  return shape != Distribution::Shape::measured && shape != Distribution::Shape::given;
}

/// The quantile at the share u of a list of ascending, equally likely values.
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
    throw std::invalid_argument("number of values must be at least " + std::to_string(least_number) + ", not " +
                                std::to_string(values.size()));
  }
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
    throw std::invalid_argument("values must be finite numbers");
  }
  const auto [least, greatest] = std::ranges::minmax(values);
  if (least == greatest) throw std::invalid_argument("values must not all be equal");
}

/// The standard deviation of a truncated normal: sigma sqrt(1 - 2 a phi(a) / (2 Phi(a) - 1)) with a = half_width /
/// sigma.
double truncated_normal_deviation(double sigma, double half_width) {
  const double a = half_width / sigma;
  if (a >= 1.0) {
    const double density = std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi);
    return sigma * std::sqrt(1.0 - 2.0 * a * density / std::erf(a / std::numbers::sqrt2));
  }
  // For smaller a, digits of the difference under the root cancel. The difference equals a^2 T / (1 + a^2 T), where T =
  // sum over n >= 1 of a^(2n-2) / (2n+1)!! is a series of positive terms, because 2 Phi(a) - 1 = 2 a phi(a) (1 + a^2
  // T).
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
      return truncated_normal_quantile(sigma_, half_width_, u);
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
      return truncated_normal_quantiles(sigma_, half_width_, uniforms);
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
