#include "engine/stats/error_scores.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

/// Computes means of functions over weighted points.
class Mean {
 public:
  explicit Mean(std::span<const double> weights) : weights_(weights) {}

  template <class Value>
  double operator()(const Value& value) const {
    double sum = 0.0;
    for (std::size_t n = 0; n < weights_.size(); ++n) sum += weights_[n] * value(n);
    return sum;
  }

 private:
  std::span<const double> weights_;
};

/// A monic polynomial and its derivative at each point [n].
struct AtPoints {
  std::vector<double> value;
  std::vector<double> slope;
};

}  // namespace

double NormalScore::ends() const {
  const double ratio = half_width / sigma;
  if (std::isinf(ratio)) return 0.0;
  const double density = std::exp(-0.5 * ratio * ratio) / std::sqrt(2.0 * std::numbers::pi);
  return 2.0 * ratio * density / std::erf(ratio / std::numbers::sqrt2);
}

double NormalScore::growth_factor() const {
  const double ratio = half_width / sigma;
  if (std::isinf(ratio)) return 1.0 / kErrorGrowth;
  return std::erf(ratio / std::numbers::sqrt2) / std::erf(ratio / kErrorGrowth / std::numbers::sqrt2) / kErrorGrowth;
}

// The growth score G = f exp(a z^2) - 1 has the mean 0, so E[G^2] = f^2 E[exp(2 a z^2)] - 1. The integrand of this mean
// is the density of a normal with the standard deviation s, times s.
double NormalScore::growth_square() const {
  const double s = kErrorGrowth / std::sqrt(2.0 - kErrorGrowth * kErrorGrowth);
  const double ratio = half_width / sigma / std::numbers::sqrt2;
  const double inside = std::isinf(ratio) ? 1.0 : std::erf(ratio / s) / std::erf(ratio);
  return std::max(0.0, growth_factor() * growth_factor() * s * inside - 1.0);
}

PolynomialScore::PolynomialScore(std::span<const double> points, std::span<const double> weights, std::size_t degree) {
  POESY_EXPECTS(points.size() == weights.size() && !points.empty() && degree <= kDegree);
  const auto [low, high] = std::ranges::minmax(points);
  POESY_EXPECTS(low < high);
  middle_ = 0.5 * (low + high);
  inverse_half_ = 2.0 / (high - low);
  const Mean mean(weights);
  std::vector<double> x;
  for (const double point : points) x.push_back((point - middle_) * inverse_half_);
  const double centre = mean([&](std::size_t n) { return x[n]; });
  sigma_ = std::sqrt(mean([&](std::size_t n) { return (x[n] - centre) * (x[n] - centre); })) / inverse_half_;
  find_polynomials(x, weights, centre, degree);
  const auto moments = [&](const auto& score) {
    std::vector<double> scores;
    for (const double point : points) scores.push_back(score(point));
    return ScoreMoments{mean([&](std::size_t n) { return scores[n] * scores[n]; }),
                        mean([&](std::size_t n) { return scores[n] * scores[n] * scores[n]; })};
  };
  moments_ = moments([&](double point) { return (*this)(point); });
  growth_moments_ = moments([&](double point) { return growth(point); });
}

// Stieltjes' procedure (Gautschi 2004, Orthogonal Polynomials, ch. 2.2.3.1), which is stable for low degrees.
void PolynomialScore::find_polynomials(std::span<const double> x, std::span<const double> weights, double centre,
                                       std::size_t degree) {
  // Smallest squared norm of a polynomial, relative to that of the previous polynomial. A smaller norm means that the
  // degree has reached the number of distinct points.
  constexpr double kNone = 1e-12;
  const std::size_t count = x.size();
  const Mean mean(weights);
  AtPoints before{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
  AtPoints now{std::vector<double>(count, 1.0), std::vector<double>(count, 0.0)};
  // `grown` has the values of the same polynomials at c + g (e - c), where the error e has grown by the factor g about
  // its mean c.
  std::vector<double> grown_before(count, 0.0);
  std::vector<double> grown(count, 1.0);
  double norm = 1.0;
  double ratio = 0.0;
  for (std::size_t k = 0; k < degree; ++k) {
    const double shift = mean([&](std::size_t n) { return x[n] * now.value[n] * now.value[n]; }) / norm;
    for (std::size_t n = 0; n < count; ++n) {  // the next polynomial takes the place of `before`
      before.slope[n] = now.value[n] + (x[n] - shift) * now.slope[n] - ratio * before.slope[n];
      before.value[n] = (x[n] - shift) * now.value[n] - ratio * before.value[n];
    }
    std::swap(before, now);
    for (std::size_t n = 0; n < count; ++n) {
      const double at = centre + kErrorGrowth * (x[n] - centre);
      grown_before[n] = (at - shift) * grown[n] - ratio * grown_before[n];
    }
    std::swap(grown_before, grown);
    const double next = mean([&](std::size_t n) { return now.value[n] * now.value[n]; });
    if (!(next > kNone * norm)) return;
    centres_[k] = shift;
    ratios_[k] = ratio;
    factors_[k] = mean([&](std::size_t n) { return now.slope[n] * (x[n] - centre); }) / next;
    grown_[k] = mean([&](std::size_t n) { return grown[n]; }) / next;
    ratio = next / norm;
    norm = next;
  }
}

double PolynomialScore::sum_at(double error, const Factors& factors, std::size_t degree) const {
  const double x = (error - middle_) * inverse_half_;
  double before = 0.0;
  double value = 1.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < degree; ++k) {
    const double next = (x - centres_[k]) * value - ratios_[k] * before;
    before = value;
    value = next;
    sum += factors[k] * value;
  }
  return sum;
}

double PolynomialScore::operator()(double error) const { return sum_at(error, factors_, kDegree); }

double PolynomialScore::growth(double error) const { return sum_at(error, grown_, kDegree); }

double PolynomialScore::parabola(double error) const { return sum_at(error, factors_, 2); }

double size_of(const ErrorScore& score) {
  if (const auto* normal = std::get_if<NormalScore>(&score)) return normal->sigma;
  if (const auto* polynomial = std::get_if<PolynomialScore>(&score)) return polynomial->sigma();
  if (const auto* block = std::get_if<BlockScore>(&score)) return block->sigma;
  return 0.0;
}

void NormalBlock::replace(std::span<double> z) const {
  const std::size_t size = errors.size();
  POESY_EXPECTS(z.size() == size && triangle.size() == size * size);
  std::vector<double> solution(z.begin(), z.end());  // solution of L L^T x = z
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < i; ++j) solution[i] -= triangle[i * size + j] * solution[j];
    solution[i] /= triangle[i * size + i];
  }
  for (std::size_t i = size; i-- > 0;) {
    solution[i] /= triangle[i * size + i];
    for (std::size_t j = 0; j < i; ++j) solution[j] -= triangle[i * size + j] * solution[i];
  }
  for (std::size_t i = 0; i < size; ++i) z[i] = z[i] * solution[i] - 1.0;
}

ScoreMoments score_moments(const ErrorScores& scores, std::size_t error) {
  if (const auto* polynomial = std::get_if<PolynomialScore>(&scores.each[error])) {
    return polynomial->moments();
  }
  for (const NormalBlock& block : scores.blocks) {
    const auto place = std::ranges::find(block.errors, error);
    if (place == block.errors.end()) continue;
    std::vector<double> unit(block.errors.size(), 0.0);
    double& at_error = unit[static_cast<std::size_t>(place - block.errors.begin())];
    at_error = 1.0;
    block.replace(unit);
    const double r = at_error + 1.0;
    return {1.0 + r, 2.0 + 6.0 * r};
  }
  POESY_EXPECTS(false);
  return {};
}

ScoreMoments growth_moments(const ErrorScores& scores, std::size_t error) {
  if (const auto* polynomial = std::get_if<PolynomialScore>(&scores.each[error])) return polynomial->growth_moments();
  constexpr double kStep = kErrorGrowth - 1.0;
  const auto [square, cube] = score_moments(scores, error);
  return {kStep * kStep * square, kStep * kStep * kStep * cube};
}

double growth_square(const ErrorScores& scores, std::size_t error) {
  const ErrorScore& score = scores.each[error];
  if (const auto* normal = std::get_if<NormalScore>(&score)) return normal->growth_square();
  const bool is_known = !std::holds_alternative<std::monostate>(score);
  return is_known ? growth_moments(scores, error).square : kNaN;
}

}  // namespace poesy
