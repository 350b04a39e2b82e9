#include "engine/stats/yield_gradient.h"

#include <cmath>
#include <numbers>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

/// The machines that are rejected.
std::vector<std::size_t> places(std::span<const std::uint8_t> rejected) {
  std::vector<std::size_t> found;
  for (std::size_t b = 0; b < rejected.size(); ++b) {
    if (rejected[b] != 0) found.push_back(b);
  }
  return found;
}

bool has_score(const ErrorScale& error) { return error.sigma > 0.0; }

/// What cutting off at +-w adds to the score: (2 w/t) phi(w/t) / (2 Phi(w/t) - 1).
double score_of_ends(const ErrorScale& error) {
  const double ratio = error.half_width / error.sigma;
  if (std::isinf(ratio)) return 0.0;
  const double density = std::exp(-0.5 * ratio * ratio) / std::sqrt(2.0 * std::numbers::pi);
  return 2.0 * ratio * density / std::erf(ratio / std::numbers::sqrt2);
}

}  // namespace

ScoreSums::ScoreSums(std::span<const ErrorScale> errors)
    : errors_(errors.begin(), errors.end()), sums_(errors.size()), squares_(errors.size()), cubes_(errors.size()) {}

void ScoreSums::add(std::span<const double> errors, std::span<const std::uint8_t> rejected) {
  const std::size_t count = rejected.size();
  POESY_EXPECTS(errors.size() == errors_.size() * count);
  const std::vector<std::size_t> rejects = places(rejected);  // few of many machines, as a rule
  for (std::size_t p = 0; p < errors_.size(); ++p) {
    if (!has_score(errors_[p])) continue;
    const std::span<const double> row = errors.subspan(p * count, count);
    const double inverse_sigma = 1.0 / errors_[p].sigma;
    double sum = 0.0;
    double squares = 0.0;
    double cubes = 0.0;
    for (const std::size_t b : rejects) {
      const double z = row[b] * inverse_sigma;
      const double score = z * z - 1.0;
      sum += score;
      squares += score * score;
      cubes += score * score * score;
    }
    sums_[p] += sum;
    squares_[p] += squares;
    cubes_[p] += cubes;
  }
  machines_ += count;
  rejects_ += rejects.size();
}

void ScoreSums::merge(const ScoreSums& other) {
  POESY_EXPECTS(other.errors_.size() == errors_.size());
  machines_ += other.machines_;
  rejects_ += other.rejects_;
  for (std::size_t p = 0; p < errors_.size(); ++p) {
    sums_[p] += other.sums_[p];
    squares_[p] += other.squares_[p];
    cubes_[p] += other.cubes_[p];
  }
}

std::vector<Estimate> ScoreSums::gradient(double conf_level) const {
  std::vector<Estimate> gradient;
  for (std::size_t p = 0; p < errors_.size(); ++p) {
    if (!has_score(errors_[p]) || machines_ == 0) {
      gradient.push_back({kNaN, {kNaN, kNaN}});
      continue;
    }
    const auto [value, interval] = mean_score(p, conf_level);
    const double sigma = errors_[p].sigma;
    gradient.push_back({-value / sigma, {-interval.high / sigma, -interval.low / sigma}});
  }
  return gradient;
}

Estimate ScoreSums::mean_score(std::size_t error, double conf_level) const {
  const auto n = static_cast<double>(machines_);
  const auto rejects = static_cast<double>(rejects_);
  const double ends = score_of_ends(errors_[error]);
  // the mean powers of the score, whose constant part is added here
  const double mean = (sums_[error] + ends * rejects) / n;
  const double mean2 = (squares_[error] + ends * (2.0 * sums_[error] + ends * rejects)) / n;
  const double mean3 =
      (cubes_[error] + ends * (3.0 * squares_[error] + ends * (3.0 * sums_[error] + ends * rejects))) / n;
  if (rejects_ < 2) return {mean, {kNaN, kNaN}};
  const double variance = mean2 - mean * mean;
  const double third = mean3 - mean * (3.0 * mean2 - 2.0 * mean * mean);
  const double z = two_sided_student_quantile(rejects - 1.0, conf_level);
  const double shift = 0.5 * z * z * third / variance / n;
  const double half = std::sqrt(shift * shift + z * z * variance / (n - 1.0));
  return {mean, {mean + shift - half, mean + shift + half}};
}

void ScoreSums::write(ByteWriter& to) const {
  to.number(machines_);
  to.number(rejects_);
  to.reals(sums_);
  to.reals(squares_);
  to.reals(cubes_);
}

ScoreSums ScoreSums::read(ByteReader& from, std::span<const ErrorScale> errors) {
  ScoreSums sums(errors);
  sums.machines_ = from.number();
  sums.rejects_ = from.number_up_to(sums.machines_);
  sums.sums_ = from.reals(errors.size());
  sums.squares_ = from.reals(errors.size());
  sums.cubes_ = from.reals(errors.size());
  const auto rejects = static_cast<double>(sums.rejects_);
  constexpr double kRounding = 1.0 + 1e-9;
  for (std::size_t p = 0; p < errors.size(); ++p) {
    const bool possible = std::isfinite(sums.squares_[p]) && std::isfinite(sums.cubes_[p]) && sums.squares_[p] >= 0.0 &&
                          sums.sums_[p] * sums.sums_[p] <= rejects * sums.squares_[p] * kRounding;
    if (!possible) throw BytesError("has sums of scores that no machines give");
  }
  return sums;
}

}  // namespace poesy
