#include "engine/stats/yield_gradient.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

/// The indices of the rejected machines in a block.
std::vector<std::size_t> places(std::span<const std::uint8_t> rejected) {
  std::vector<std::size_t> found;
  for (std::size_t b = 0; b < rejected.size(); ++b) {
    if (rejected[b] != 0) found.push_back(b);
  }
  return found;
}

/// Sums powers of a score over the rejects. score(machine): the score of the error.
template <class Score>
PowerSums power_sums(std::span<const std::size_t> rejects, const Score score) {
  PowerSums sums;
  for (const std::size_t b : rejects) sums.add(score(b));
  return sums;
}

/// The sums for a normal error. The two functions are not inlined, so that the compiler keeps their sums in registers.
/// @{
[[gnu::noinline]] PowerSums slope_sums(const NormalScore& score, std::span<const double> row,
                                       std::span<const std::size_t> rejects) {
  const double inverse_sigma = 1.0 / score.sigma;
  return power_sums(rejects, [row, inverse_sigma, centre = score.centre](std::size_t b) {
    const double z = (row[b] - centre) * inverse_sigma;
    return z * z - 1.0;
  });
}

[[gnu::noinline]] PowerSums growth_sums(const NormalScore& score, std::span<const double> row,
                                        std::span<const std::size_t> rejects) {
  const double inverse_sigma = 1.0 / score.sigma;
  const double factor = score.growth_factor();
  return power_sums(rejects, [row, inverse_sigma, factor, centre = score.centre](std::size_t b) {
    const double z = (row[b] - centre) * inverse_sigma;
    return factor * std::exp(NormalScore::growth_exponent() * z * z) - 1.0;
  });
}
/// @}

constexpr Estimate kUnknown{kNaN, {kNaN, kNaN}};

/// Returns true if the mean over the rejects is negative, by Student's test at 99 %. Precondition: rejects > 1.
bool is_below_zero(const PowerSums& powers, std::uint64_t rejects) {
  constexpr double kLevel = 0.99;
  const auto k = static_cast<double>(rejects);
  const double mean = powers.sum / k;
  const double variance = std::max(0.0, powers.square / k - mean * mean) / (k - 1.0);
  return mean + two_sided_student_quantile(k - 1.0, kLevel) * std::sqrt(variance) < 0.0;
}

void sums_state(Archive& archive, std::uint64_t rejects, std::vector<PowerSums>& sums) {
  constexpr double kRounding = 1.0 + 1e-9;
  for (const auto member : {&PowerSums::sum, &PowerSums::square, &PowerSums::cube}) {
    for (PowerSums& one : sums) archive.real(one.*member);
  }
  for (const PowerSums& one : sums) {
    const bool possible = std::isfinite(one.square) && std::isfinite(one.cube) && one.square >= 0.0 &&
                          one.sum * one.sum <= static_cast<double>(rejects) * one.square * kRounding;
    archive.expect(possible, "has sums of scores that no machines give");
  }
}

}  // namespace

Estimate skewed_mean(const PowerSums& powers, std::uint64_t machines, const ScoreMoments& added, double freedom,
                     double conf_level) {
  const auto n = static_cast<double>(machines);
  const double mean = powers.sum / n;
  if (!(freedom >= 1.0)) return {mean, {kNaN, kNaN}};
  const double mean2 = powers.square / n + added.square;
  const double mean3 = powers.cube / n + added.cube;
  const double variance = mean2 - mean * mean;
  const double third = mean3 - mean * (3.0 * mean2 - 2.0 * mean * mean);
  const double z = two_sided_student_quantile(freedom, conf_level);
  const double shift = 0.5 * z * z * third / variance / n;
  const double half = std::sqrt(shift * shift + z * z * variance / (n - 1.0));
  return {mean, {mean + shift - half, mean + shift + half}};
}

Estimate within(const Estimate& estimate, double least, double most) {
  const auto kept = [&](double value) { return std::isnan(value) ? value : std::clamp(value, least, most); };
  return {kept(estimate.value), {kept(estimate.interval.low), kept(estimate.interval.high)}};
}

ScoreSums::ScoreSums(ErrorScores scores)
    : scores_(std::move(scores)),
      slope_(scores_.each.size()),
      growth_(scores_.each.size()),
      less_(scores_.each.size()),
      more_(scores_.each.size()) {}

void ScoreSums::add(std::span<const double> errors, std::span<const std::uint8_t> rejected) {
  const std::size_t count = rejected.size();
  POESY_EXPECTS(errors.size() == slope_.size() * count);
  const std::vector<std::size_t> rejects = places(rejected);  // rejects are usually few, and good machines add nothing
  for (std::size_t p = 0; p < slope_.size(); ++p) {
    const std::span<const double> row = errors.subspan(p * count, count);
    if (const auto* normal = std::get_if<NormalScore>(&scores_.each[p])) {
      slope_[p] += slope_sums(*normal, row, rejects);
      growth_[p] += growth_sums(*normal, row, rejects);
    } else if (const auto* polynomial = std::get_if<PolynomialScore>(&scores_.each[p])) {
      slope_[p] += power_sums(rejects, [&](std::size_t b) { return (*polynomial)(row[b]); });
      growth_[p] += power_sums(rejects, [&](std::size_t b) { return polynomial->growth(row[b]); });
      less_[p] += power_sums(rejects,
                             [&](std::size_t b) { return polynomial->parabola(row[b]) - 0.5 * (*polynomial)(row[b]); });
      more_[p] += power_sums(rejects,
                             [&](std::size_t b) { return 2.0 * (*polynomial)(row[b]) - polynomial->parabola(row[b]); });
    }
  }
  for (const NormalBlock& block : scores_.blocks) add_block(block, errors, count, rejects);
  machines_ += count;
  rejects_ += rejects.size();
}

void ScoreSums::add_block(const NormalBlock& block, std::span<const double> errors, std::size_t count,
                          std::span<const std::size_t> rejects) {
  const std::size_t size = block.errors.size();
  std::vector<double> z(size);
  std::vector<PowerSums> found(size);
  for (const std::size_t b : rejects) {
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t p = block.errors[i];
      const auto& [sigma, centre] = std::get<BlockScore>(scores_.each[p]);
      z[i] = (errors[p * count + b] - centre) / sigma;
    }
    block.replace(z);
    for (std::size_t i = 0; i < size; ++i) found[i].add(z[i]);
  }
  for (std::size_t i = 0; i < size; ++i) slope_[block.errors[i]] += found[i];
}

void ScoreSums::merge(const ScoreSums& other) {
  POESY_EXPECTS(other.slope_.size() == slope_.size());
  machines_ += other.machines_;
  rejects_ += other.rejects_;
  for (std::size_t p = 0; p < slope_.size(); ++p) {
    slope_[p] += other.slope_[p];
    growth_[p] += other.growth_[p];
    less_[p] += other.less_[p];
    more_[p] += other.more_[p];
  }
}

std::vector<Estimate> ScoreSums::gradient(double conf_level) const {
  std::vector<Estimate> gradient;
  for (std::size_t p = 0; p < slope_.size(); ++p) {
    const double sigma = size_of(scores_.each[p]);
    if (sigma == 0.0 || machines_ == 0) {
      gradient.push_back(kUnknown);
      continue;
    }
    const Estimate score = mean_score(p, conf_level);
    const auto& [value, interval] = score;
    gradient.push_back(dominates(p, score) ? kUnknown
                                           : Estimate{-value / sigma, {-interval.high / sigma, -interval.low / sigma}});
  }
  return gradient;
}

std::vector<Estimate> ScoreSums::change(double conf_level) const {
  std::vector<Estimate> change;
  for (std::size_t p = 0; p < slope_.size(); ++p) {
    const bool known = size_of(scores_.each[p]) > 0.0 && machines_ > 0;
    if (!known || dominates(p, mean_score(p, conf_level))) {
      change.push_back(kUnknown);
      continue;
    }
    const double rejects = static_cast<double>(rejects_) / static_cast<double>(machines_);
    const auto [value, interval] = mean_growth(p, conf_level);
    change.push_back(within({-value, {-interval.high, -interval.low}}, rejects - 1.0, rejects));
  }
  return change;
}

std::vector<double> ScoreSums::change_sd_without_effect() const {
  const auto rejects = static_cast<double>(rejects_);
  std::vector<double> sd;
  for (std::size_t p = 0; p < scores_.each.size(); ++p) {
    sd.push_back(std::sqrt(growth_square(scores_, p) * rejects) / static_cast<double>(machines_));
  }
  return sd;
}

bool ScoreSums::dominates(std::size_t error, const Estimate& score) const {
  if (!std::holds_alternative<PolynomialScore>(scores_.each[error])) return false;
  return score.interval.low > 0.0 && (is_below_zero(less_[error], rejects_) || is_below_zero(more_[error], rejects_));
}

Estimate ScoreSums::mean_score(std::size_t error, double conf_level) const {
  const auto n = static_cast<double>(machines_);
  const auto rejects = static_cast<double>(rejects_);
  const auto* const normal = std::get_if<NormalScore>(&scores_.each[error]);
  const double ends = normal == nullptr ? 0.0 : normal->ends();
  const auto [sum, square, cube] = slope_[error];
  // The powers of z^2 - 1 and the constant part `ends` together give the powers of the score.
  const PowerSums powers{sum + ends * rejects, square + ends * (2.0 * sum + ends * rejects),
                         cube + ends * (3.0 * square + ends * (3.0 * sum + ends * rejects))};
  ScoreMoments added{0.0, 0.0};
  if (normal == nullptr && rejects_ >= 2) {
    const ScoreMoments all = score_moments(scores_, error);
    added = {kAddedRejects * all.square / n, kAddedRejects * all.cube / n};
  }
  return skewed_mean(powers, machines_, added, rejects - 1.0, conf_level);
}

Estimate ScoreSums::mean_growth(std::size_t error, double conf_level) const {
  if (std::holds_alternative<BlockScore>(scores_.each[error])) {
    constexpr double kStep = kErrorGrowth - 1.0;
    const auto [value, interval] = mean_score(error, conf_level);
    return {kStep * value, {kStep * interval.low, kStep * interval.high}};
  }
  const auto n = static_cast<double>(machines_);
  ScoreMoments added{0.0, 0.0};
  if (std::holds_alternative<PolynomialScore>(scores_.each[error])) {
    const ScoreMoments all = growth_moments(scores_, error);
    added = {kAddedRejects * all.square / n, kAddedRejects * all.cube / n};
  }
  return skewed_mean(growth_[error], machines_, added, static_cast<double>(rejects_) - 1.0, conf_level);
}

void ScoreSums::state(Archive& archive) {
  archive.number(machines_);
  archive.number(rejects_, machines_);
  for (auto* sums : {&slope_, &growth_, &less_, &more_}) sums_state(archive, rejects_, *sums);
}

}  // namespace poesy
