#include "engine/run/rounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/study/plan.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double half_width(const Estimate& estimate) {
  const auto [low, high] = estimate.interval;
  const bool known = std::isfinite(low) && std::isfinite(high);
  return known ? std::max(estimate.value - low, high - estimate.value) : kNaN;
}

}  // namespace

std::vector<std::size_t> all_positions(std::size_t count) {
  std::vector<std::size_t> positions(count);
  std::iota(positions.begin(), positions.end(), std::size_t{0});
  return positions;
}

std::size_t least_samples(const Plan& plan) {
  if (!plan.adaptive()) return plan.samples();
  const std::vector<std::size_t> list = milestones(plan.adaptive()->min, plan.samples());
  return list.empty() ? plan.samples() : list.front();
}

Rounds::Rounds(const Plan& plan, Rule rule)
    : adaptive_(plan.adaptive()),
      rule_(std::move(rule)),
      poses_(plan.poses().size()),
      max_(plan.samples()),
      milestones_(adaptive_ ? milestones(adaptive_->min, max_) : std::vector<std::size_t>()),
      samples_(plan.slots(), least_samples(plan)),
      ended_(plan.slots(), false) {
  POESY_EXPECTS(!adaptive_ || rule_.rounding.size() == rule_.responses * samples_.size());
}

std::size_t Rounds::units(std::size_t slot) const { return Plan::units_for(samples_[slot]); }

bool Rounds::may_hold(std::size_t slot, std::size_t units) const {
  const std::size_t before =
      rows_.empty() ? 0 : Plan::units_for(ended_[slot] ? samples_[slot] : milestones_[rows_.size() - 1]);
  return before <= units && units <= Plan::units_for(samples_[slot]);
}

double Rounds::excess(const Row& row, std::size_t cell) const {
  const double quantity = std::abs(row.quantity[cell]);
  if (quantity < rule_.rounding[cell] || row.half_width[cell] == 0.0) return 0.0;
  const double excess = row.half_width[cell] / (adaptive_->relative_error * quantity);
  return std::isnan(excess) ? kInfinity : excess;
}

double Rounds::largest_excess(const Row& row, std::size_t slot) const {
  double largest = 0.0;
  for (const std::size_t r : rule_.deciding) largest = std::max(largest, excess(row, cell(r, slot)));
  return largest;
}

std::size_t Rounds::expected_samples(std::size_t slot) const {
  if (ended_[slot]) return samples_[slot];
  if (rows_.empty()) return max_;
  const double excess = largest_excess(rows_.back(), slot);
  const double needed = static_cast<double>(milestones_[rows_.size() - 1]) * excess * excess;
  const auto first = milestones_.begin() + static_cast<std::ptrdiff_t>(rows_.size());
  const auto found = std::find_if(first, milestones_.end(),
                                  [&](std::size_t milestone) { return static_cast<double>(milestone) >= needed; });
  return found == milestones_.end() ? max_ : *found;
}

std::uint64_t Rounds::expected_solves() const {
  std::uint64_t solves = 0;
  for (std::size_t slot = 0; slot < samples_.size(); ++slot) solves += std::uint64_t{expected_samples(slot)} * poses_;
  return solves;
}

bool Rounds::go_on(const std::function<std::vector<Estimate>(std::size_t slot)>& estimates) {
  if (!adaptive_) return false;
  const std::size_t cells = rule_.responses * samples_.size();
  Row row{std::vector<double>(cells, kNaN), std::vector<double>(cells, kNaN)};
  for (std::size_t slot = 0; slot < samples_.size(); ++slot) {
    if (ended_[slot]) continue;
    const std::vector<Estimate> found = estimates(slot);
    POESY_EXPECTS(found.size() == rule_.responses);
    for (std::size_t r = 0; r < found.size(); ++r) {
      row.quantity[cell(r, slot)] = found[r].value;
      row.half_width[cell(r, slot)] = half_width(found[r]);
    }
  }
  if (!last_round()) return decide(std::move(row));
  rows_.push_back(std::move(row));
  return false;
}

bool Rounds::decide(Row row) {
  rows_.push_back(std::move(row));
  const std::size_t next = last_round() ? max_ : milestones_[rows_.size()];
  bool another = false;
  for (std::size_t slot = 0; slot < samples_.size(); ++slot) {
    if (!ended_[slot]) ended_[slot] = largest_excess(rows_.back(), slot) <= 1.0;
    if (ended_[slot]) continue;
    samples_[slot] = next;
    another = true;
  }
  return another;
}

const Rounds::Row& Rounds::row_at_end(std::size_t slot) const {
  const auto row = std::ranges::find(milestones_, samples_[slot]) - milestones_.begin();
  return rows_[static_cast<std::size_t>(row)];
}

std::optional<ConvergenceResult> Rounds::result() const {
  if (!adaptive_) return std::nullopt;
  ConvergenceResult result;
  result.min = adaptive_->min;
  result.max = max_;
  result.relative_error = adaptive_->relative_error;
  EstimateCourse& course = result.course;
  course.conf_level = rule_.conf_level;
  for (std::size_t k = 0; k < rows_.size(); ++k)
    course.samples.push_back(k < milestones_.size() ? milestones_[k] : max_);
  for (std::size_t r = 0; r < rule_.responses; ++r) {
    for (std::size_t slot = 0; slot < samples_.size(); ++slot) {
      const std::size_t at = cell(r, slot);
      for (const Row& row : rows_) {
        course.value.push_back(row.quantity[at]);
        course.half_width.push_back(row.half_width[at]);
      }
      const Row& end = row_at_end(slot);
      result.reached.push_back(excess(end, at) <= 1.0 ? 1 : 0);
      result.relative_half_width.push_back(end.half_width[at] / std::abs(end.quantity[at]));
    }
  }
  result.samples.assign(samples_.begin(), samples_.end());
  return result;
}

void Rounds::state(Archive& archive) {
  if (!adaptive_) return;
  const std::size_t cells = rule_.responses * samples_.size();
  std::uint64_t rounds = rows_.size();
  archive.number(rounds, milestones_.size());
  for (std::size_t k = 0; k < rounds; ++k) {
    Row row = archive.reads() ? Row{std::vector<double>(cells), std::vector<double>(cells)} : rows_[k];
    archive.reals(row.quantity);
    archive.reals(row.half_width);
    if (archive.reads()) archive.expect(decide(std::move(row)), "goes on although it came to its end");
  }
}

}  // namespace poesy
