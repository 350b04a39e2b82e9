#include "engine/stats/yield_gradient.h"

#include <cmath>
#include <utility>

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

/// So many rejects, with any error, are added where the spread of a score is estimated, because few rejects need not
/// have had its largest values (as Agresti and Coull 1998, Am. Stat. 52, 119-126, add two of each kind for a share).
constexpr double kAdded = 4.0;

/// Sums of the powers of one error's score.
struct ScorePowers {
  double sum = 0.0;
  double squares = 0.0;
  double cubes = 0.0;

  void add(double score) {
    sum += score;
    squares += score * score;
    cubes += score * score * score;
  }
};

/// score: of the error at a machine.
template <class Score>
ScorePowers score_powers(std::span<const std::size_t> rejects, const Score score) {
  ScorePowers sums;
  for (const std::size_t b : rejects) sums.add(score(b));
  return sums;
}

/// Of a normal error. Never inlined, because its sums then stay in registers.
[[gnu::noinline]] ScorePowers score_powers(const NormalScore& score, std::span<const double> row,
                                           std::span<const std::size_t> rejects) {
  const double inverse_sigma = 1.0 / score.sigma;
  return score_powers(rejects, [row, inverse_sigma](std::size_t b) {
    const double z = row[b] * inverse_sigma;
    return z * z - 1.0;
  });
}

/// Of an error that depends on no other. row: [B].
ScorePowers score_powers(const ErrorScore& score, std::span<const double> row, std::span<const std::size_t> rejects) {
  if (const auto* normal = std::get_if<NormalScore>(&score)) return score_powers(*normal, row, rejects);
  if (const auto* polynomial = std::get_if<PolynomialScore>(&score)) {
    return score_powers(rejects, [&](std::size_t b) { return (*polynomial)(row[b]); });
  }
  return {};
}

}  // namespace

ScoreSums::ScoreSums(ErrorScores scores)
    : scores_(std::move(scores)),
      sums_(scores_.each.size()),
      squares_(scores_.each.size()),
      cubes_(scores_.each.size()) {}

void ScoreSums::add(std::span<const double> errors, std::span<const std::uint8_t> rejected) {
  const std::size_t count = rejected.size();
  POESY_EXPECTS(errors.size() == sums_.size() * count);
  const std::vector<std::size_t> rejects = places(rejected);  // few of many machines, as a rule
  for (std::size_t p = 0; p < sums_.size(); ++p) {
    const ScorePowers found = score_powers(scores_.each[p], errors.subspan(p * count, count), rejects);
    sums_[p] += found.sum;
    squares_[p] += found.squares;
    cubes_[p] += found.cubes;
  }
  for (const NormalBlock& block : scores_.blocks) add_block(block, errors, count, rejects);
  machines_ += count;
  rejects_ += rejects.size();
}

void ScoreSums::add_block(const NormalBlock& block, std::span<const double> errors, std::size_t count,
                          std::span<const std::size_t> rejects) {
  const std::size_t size = block.errors.size();
  std::vector<double> z(size);
  std::vector<ScorePowers> found(size);
  for (const std::size_t b : rejects) {
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t p = block.errors[i];
      z[i] = errors[p * count + b] / size_of(scores_.each[p]);
    }
    block.replace(z);
    for (std::size_t i = 0; i < size; ++i) found[i].add(z[i]);
  }
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t p = block.errors[i];
    sums_[p] += found[i].sum;
    squares_[p] += found[i].squares;
    cubes_[p] += found[i].cubes;
  }
}

void ScoreSums::merge(const ScoreSums& other) {
  POESY_EXPECTS(other.sums_.size() == sums_.size());
  machines_ += other.machines_;
  rejects_ += other.rejects_;
  for (std::size_t p = 0; p < sums_.size(); ++p) {
    sums_[p] += other.sums_[p];
    squares_[p] += other.squares_[p];
    cubes_[p] += other.cubes_[p];
  }
}

std::vector<Estimate> ScoreSums::gradient(double conf_level) const {
  std::vector<Estimate> gradient;
  for (std::size_t p = 0; p < sums_.size(); ++p) {
    const double sigma = size_of(scores_.each[p]);
    if (sigma == 0.0 || machines_ == 0) {
      gradient.push_back({kNaN, {kNaN, kNaN}});
      continue;
    }
    const auto [value, interval] = mean_score(p, conf_level);
    gradient.push_back({-value / sigma, {-interval.high / sigma, -interval.low / sigma}});
  }
  return gradient;
}

Estimate ScoreSums::mean_score(std::size_t error, double conf_level) const {
  const auto n = static_cast<double>(machines_);
  const auto rejects = static_cast<double>(rejects_);
  const auto* const normal = std::get_if<NormalScore>(&scores_.each[error]);
  const double ends = normal == nullptr ? 0.0 : normal->ends();
  // the mean powers of the score, whose constant part is added here
  const double mean = (sums_[error] + ends * rejects) / n;
  double mean2 = (squares_[error] + ends * (2.0 * sums_[error] + ends * rejects)) / n;
  double mean3 = (cubes_[error] + ends * (3.0 * squares_[error] + ends * (3.0 * sums_[error] + ends * rejects))) / n;
  if (rejects_ < 2) return {mean, {kNaN, kNaN}};
  if (normal == nullptr) {
    const ScoreMoments all = score_moments(scores_, error);
    mean2 += kAdded * all.square / n;
    mean3 += kAdded * all.cube / n;
  }
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

ScoreSums ScoreSums::read(ByteReader& from, const ErrorScores& scores) {
  ScoreSums sums(scores);
  const std::size_t errors = scores.each.size();
  sums.machines_ = from.number();
  sums.rejects_ = from.number_up_to(sums.machines_);
  sums.sums_ = from.reals(errors);
  sums.squares_ = from.reals(errors);
  sums.cubes_ = from.reals(errors);
  const auto rejects = static_cast<double>(sums.rejects_);
  constexpr double kRounding = 1.0 + 1e-9;
  for (std::size_t p = 0; p < errors; ++p) {
    const bool possible = std::isfinite(sums.squares_[p]) && std::isfinite(sums.cubes_[p]) && sums.squares_[p] >= 0.0 &&
                          sums.sums_[p] * sums.sums_[p] <= rejects * sums.squares_[p] * kRounding;
    if (!possible) throw BytesError("has sums of scores that no machines give");
  }
  return sums;
}

}  // namespace poesy
