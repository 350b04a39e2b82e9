#include "engine/run/evaluate_unit.h"

#include "engine/run/history_points.h"

#include <algorithm>
#include <array>

#include "engine/base/contract.h"
#include "engine/random/stream.h"
#include "engine/run/counts.h"

namespace poesy {
namespace {

/// Largest error to expect: one draw in 16 000 of a normal lies beyond four standard deviations.
double expected_range(const Distribution& distribution) {
  return std::min(distribution.half_width(), 4.0 * distribution.standard_deviation());
}

}  // namespace

void UnitStats::merge(const UnitStats& other) {
  if (responses.empty()) responses.resize(other.responses.size());
  for (std::size_t r = 0; r < responses.size(); ++r) responses[r].merge(other.responses[r]);
  solves.merge(other.solves);
  failed.merge(other.failed);
}

void UnitStats::write(ByteWriter& to) const {
  for (const Moments& moments : responses) moments.write(to);
  solves.write(to);
  failed.write(to);
}

UnitStats UnitStats::read(ByteReader& from, std::size_t responses, std::uint64_t first) {
  UnitStats stats;
  for (std::size_t r = 0; r < responses; ++r) stats.responses.push_back(Moments::read(from));
  stats.solves = SolveCounts::read(from);
  stats.failed = FailedSamples::read(from, stats.solves.not_converged(), first, first + stats.solves.total());
  return stats;
}

void CellUnit::write(ByteWriter& to) const {
  UnitStats::write(to);
  for (const LocalIndex& index : within) to.reals(std::array{index.value, index.standard_error});
}

CellUnit CellUnit::read(ByteReader& from, std::size_t responses, std::uint64_t first, std::size_t points) {
  CellUnit unit{UnitStats::read(from, responses, first), {}};
  for (std::size_t n = 0; n < points * responses; ++n) {
    const double value = from.real();
    unit.within.push_back({value, from.real()});
  }
  return unit;
}

std::span<const std::size_t> points_within(const WorkUnit& unit, std::span<const std::size_t> points) {
  if (unit.first.value > 0) return {};
  return points.first(static_cast<std::size_t>(std::ranges::lower_bound(points, unit.count) - points.begin()));
}

UnitEvaluator::UnitEvaluator(const Plan& plan, const Model& model)
    : plan_(&plan),
      responses_(model.description().responses.size()),
      evaluator_(model.evaluator(plan.solver())),
      values_(Plan::kUnitSamples),
      outcome_(responses_ * Plan::kUnitSamples),
      status_(Plan::kUnitSamples),
      iterations_(Plan::kUnitSamples),
      points_(history_points(plan)) {}

UnitOutcomes UnitEvaluator::solve(const WorkUnit& unit) { return solve(unit, std::array{1.0}); }

UnitOutcomes UnitEvaluator::solve(const WorkUnit& unit, std::span<const double> scales) {
  const std::size_t count = scales.size() * unit.count;
  POESY_EXPECTS(count <= Plan::kUnitSamples);
  const std::span values = std::span(values_).first(count);
  const std::span draws = values.first(unit.count);
  const std::span outcome = std::span(outcome_).first(responses_ * count);
  const FactorIndex factor = plan_->factors()[unit.slot];
  fill_uniforms({plan_->seed(), Purpose::error_samples, factor, unit.pose}, unit.first, draws);
  plan_->distributions()[unit.slot].transform(draws);
  for (std::size_t k = scales.size(); k-- > 0;) {  // the first ones last, because the others are made of them
    for (std::size_t b = 0; b < unit.count; ++b) values[k * unit.count + b] = scales[k] * draws[b];
  }
  const std::span status = std::span(status_).first(count);
  const std::span iterations = std::span(iterations_).first(count);
  evaluator_->evaluate({plan_->poses()[unit.pose], plan_->background(), std::span(&factor, 1), values, count,
                        expected_range(plan_->distributions()[unit.slot])},
                       {outcome, status, iterations, {}});
  return {values, outcome, status, iterations};
}

CellUnit UnitEvaluator::operator()(const WorkUnit& unit) {
  const UnitOutcomes outcomes = solve(unit);
  const std::span<const std::size_t> points = points_within(unit, points_);
  const double sigma = plan_->distributions()[unit.slot].standard_deviation();
  CellUnit found;
  found.responses.reserve(responses_);
  found.within.resize(points.size() * responses_);
  kept_.clear();
  for (std::size_t b = 0; b < unit.count; ++b) {
    found.solves.add(outcomes.status[b], outcomes.iterations[b]);
    found.failed.add(SampleIndex(unit.first.value + b), outcomes.status[b]);
    if (counts(outcomes.status[b], plan_->not_converged())) kept_.push_back(b);
  }
  for (std::size_t r = 0; r < responses_; ++r) {
    for (std::size_t n = 0; n < kept_.size(); ++n) values_[n] = outcomes.responses[r * unit.count + kept_[n]];
    const std::span<const double> kept = std::span(values_).first(kept_.size());
    found.responses.push_back(Moments::of(kept));
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto count = static_cast<std::size_t>(std::ranges::lower_bound(kept_, points[k]) - kept_.begin());
      found.within[k * responses_ + r] = local_index_with_error(Moments::of(kept.first(count)), sigma);
    }
  }
  return found;
}

}  // namespace poesy
