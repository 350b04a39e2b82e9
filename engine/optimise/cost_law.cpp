#include "engine/optimise/cost_law.h"

#include <cmath>
#include <limits>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// x^exponent for x >= 0. Common exponents are computed without std::pow, which is slower.
double raised(double x, double exponent) {
  if (exponent == 0.5) return std::sqrt(x);
  if (exponent == 1.0) return x;
  if (exponent == 2.0) return x * x;
  return std::pow(x, exponent);
}

/// x^(1 / n) for x >= 0.
double root(double x, double n) {
  if (n == 1.5) return std::pow(std::cbrt(x), 2);
  if (n == 2.0) return std::sqrt(x);
  if (n == 3.0) return std::cbrt(x);
  return std::pow(x, 1.0 / n);
}

/// The z > 0 with z + log z = value (Lambert's W of exp(value)), by Newton's method; 0 if z underflows.
double with_own_logarithm(double value) {
  double z = value > 1.0 ? value - std::log(value) : std::exp(value) / (1.0 + std::exp(value));
  if (z == 0.0) return z;
  for (int step = 0; step < 20; ++step) {
    const double change = (value - z - std::log(z)) / (1.0 + z);
    z *= 1.0 + change;
    if (std::abs(change) < 1e-9) break;  // the next change is about the square of this one
  }
  return z;
}

}  // namespace

double size_of(double tolerance, Stacking stacking) {
  return stacking == Stacking::root_sum_square ? tolerance * tolerance : tolerance;
}

double tolerance_of(double size, Stacking stacking) {
  return stacking == Stacking::root_sum_square ? std::sqrt(size) : size;
}

CostLaw::CostLaw(Form form, double fixed, double b, double shape)
    : form_(b == 0.0 ? Form::constant : form), fixed_(fixed), b_(b), shape_(shape) {
  POESY_EXPECTS(std::isfinite(fixed) && std::isfinite(b) && b >= 0.0 && shape > 0.0);
}

CostLaw CostLaw::constant(double cost) { return {Form::constant, cost, 0.0, 1.0}; }

CostLaw CostLaw::reciprocal(double fixed, double b) { return {Form::power, fixed, b, 1.0}; }

CostLaw CostLaw::reciprocal_power(double fixed, double b, double power) { return {Form::power, fixed, b, power}; }

CostLaw CostLaw::exponential(double fixed, double b, double decay) { return {Form::exponential, fixed, b, decay}; }

double CostLaw::exponent(Stacking stacking) const {
  return stacking == Stacking::root_sum_square ? 0.5 * shape_ : shape_;
}

double CostLaw::at(double tolerance) const {
  switch (form_) {
    case Form::constant:
      return fixed_;
    case Form::power:
      return fixed_ + b_ / raised(tolerance, shape_);
    case Form::exponential:
      break;
  }
  return fixed_ + b_ * std::exp(-tolerance / shape_);
}

CostCurve CostLaw::curve(double size, Stacking stacking) const {
  if (form_ == Form::constant) return {fixed_, 0.0, 0.0};
  if (form_ == Form::power) {
    const double q = exponent(stacking);
    const double part = b_ / raised(size, q);
    const double slope = -q * part / size;
    return {fixed_ + part, slope, -(q + 1.0) * slope / size};
  }
  const double tolerance = tolerance_of(size, stacking);
  const double part = b_ * std::exp(-tolerance / shape_);
  if (stacking == Stacking::worst_case) return {fixed_ + part, -part / shape_, part / (shape_ * shape_)};
  const double slope = -0.5 * part / (tolerance * shape_);
  return {fixed_ + part, slope, -0.5 * slope * (tolerance + shape_) / (size * shape_)};
}

double CostLaw::cheapest_size(double price, Stacking stacking) const {
  POESY_EXPECTS(price >= 0.0 && form_ != Form::constant);
  if (price == 0.0) return kInfinity;
  if (form_ == Form::power) {
    const double q = exponent(stacking);
    return root(q * b_ / price, q + 1.0);
  }
  // At the cheapest size, the cost falls by `price` per unit of size. For Stacking::worst_case (size T), b / decay
  // exp(-T / decay) = price; for Stacking::root_sum_square (size T^2), b / (2 T decay) exp(-T / decay) = price.
  if (stacking == Stacking::worst_case) return std::fmax(0.0, shape_ * std::log(b_ / (shape_ * price)));
  const double value = std::log(b_) - 2.0 * std::log(shape_) - std::log(2.0 * price);
  const double tolerance = shape_ * with_own_logarithm(value);
  return tolerance * tolerance;
}

}  // namespace poesy
