#include "engine/kinds/monte_carlo/part_sums.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/array.h"
#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/random/normal_quantile.h"

namespace poesy::monte_carlo {
namespace {

double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }

double share_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double square_sum(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum;
}

}  // namespace

PartSums::PartSums(const PartGroups& groups) : groups_(&groups), squares_(groups.each.size(), 0.0) {
  for (const PartGroup& group : groups.each) sums_.emplace_back(group.size(), 0.0);
}

void PartSums::add(std::span<const double> errors, std::span<const std::uint8_t> rejected) {
  const std::size_t count = rejected.size();
  if (count == 0) return;
  const ArrayView<const double, axis::Factor, axis::Sample> of_machines(errors, {errors.size() / count, count});
  machines_ += count;
  for (std::size_t b = 0; b < count; ++b) {
    if (rejected[b] == 0) continue;
    ++rejects_;
    for (std::size_t g = 0; g < sums_.size(); ++g) {
      const PartGroup& group = groups_->each[g];
      std::vector<double> influence(group.size(), 0.0);
      std::vector<double> x;
      for (const std::size_t p : group.errors) x.push_back(of_machines(p, b));
      add_influence(group, x, influence);
      for (std::size_t i = 0; i < influence.size(); ++i) {
        sums_[g][i] += influence[i];
        squares_[g] += influence[i] * influence[i];
      }
    }
  }
}

void PartSums::merge(const PartSums& later) {
  POESY_EXPECTS(later.sums_.size() == sums_.size());
  machines_ += later.machines_;
  rejects_ += later.rejects_;
  for (std::size_t g = 0; g < sums_.size(); ++g) {
    for (std::size_t i = 0; i < sums_[g].size(); ++i) sums_[g][i] += later.sums_[g][i];
    squares_[g] += later.squares_[g];
  }
}

Interval PartSums::interval(double conf_level) const {
  if (!groups_->known || rejects_ < kLeast || machines_ - rejects_ < kLeast) return {kNaN, kNaN};
  const auto machines = static_cast<double>(machines_);
  const double yield = 1.0 - static_cast<double>(rejects_) / machines;
  double of_parts = 0.0;
  // The sum over the groups of variance^2 / degrees of freedom, for the formula of Welch and Satterthwaite.
  double squares = 0.0;
  for (std::size_t g = 0; g < sums_.size(); ++g) {
    const auto n = static_cast<double>(sums_[g].size());
    // The square of a sum over few machines is too large on average; subtracting `squares_` removes this bias.
    const double variance = (square_sum(sums_[g]) - squares_[g]) / (machines * machines * n * (n - 1.0));
    of_parts += variance;
    squares += variance * variance / (n - 1.0);
  }
  of_parts = std::max(of_parts, 0.0);
  const double freedom = squares > 0.0 ? std::max(of_parts * of_parts / squares, 1.0) : machines;
  const double z = normal_quantile(1.0, yield);
  const double deviation = std::sqrt(of_parts + yield * (1.0 - yield) / machines) / density(z);
  const double half = two_sided_student_quantile(freedom, conf_level) * deviation;
  return {share_below(z - half), share_below(z + half)};
}

void PartSums::state(Archive& archive) {
  archive.number(machines_);
  archive.number(rejects_, machines_);
  for (std::vector<double>& each : sums_) archive.reals(each);
  archive.reals(squares_);
  const auto rejects = static_cast<double>(rejects_);
  constexpr double kRounding = 1.0 + 1e-9;
  for (std::size_t g = 0; g < sums_.size(); ++g) {
    const bool possible = std::isfinite(squares_[g]) && square_sum(sums_[g]) <= rejects * squares_[g] * kRounding;
    archive.expect(possible, "has sums over parts that no machines give");
  }
}

}  // namespace poesy::monte_carlo
