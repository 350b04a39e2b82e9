#include "engine/run/evaluate_unit.h"

#include <algorithm>

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

UnitEvaluator::UnitEvaluator(const Plan& plan, const Model& model)
    : plan_(&plan),
      responses_(model.description().responses.size()),
      evaluator_(model.evaluator(plan.solver())),
      values_(Plan::kUnitSamples),
      outcome_(responses_ * Plan::kUnitSamples),
      status_(Plan::kUnitSamples),
      iterations_(Plan::kUnitSamples) {}

UnitOutcomes UnitEvaluator::solve(const WorkUnit& unit) {
  const std::span values = std::span(values_).first(unit.count);
  const std::span outcome = std::span(outcome_).first(responses_ * unit.count);
  const FactorIndex factor = plan_->factors()[unit.slot];
  fill_uniforms({plan_->seed(), Purpose::error_samples, factor, unit.pose}, unit.first, values);
  plan_->distributions()[unit.slot].transform(values);
  const std::span status = std::span(status_).first(unit.count);
  const std::span iterations = std::span(iterations_).first(unit.count);
  evaluator_->evaluate({plan_->poses()[unit.pose], plan_->background(), std::span(&factor, 1), values, unit.count,
                        expected_range(plan_->distributions()[unit.slot])},
                       {outcome, status, iterations, {}});
  return {values, outcome, status, iterations};
}

UnitStats UnitEvaluator::operator()(const WorkUnit& unit) {
  const UnitOutcomes outcomes = solve(unit);
  UnitStats stats;
  stats.responses.reserve(responses_);
  kept_.clear();
  for (std::size_t b = 0; b < unit.count; ++b) {
    stats.solves.add(outcomes.status[b], outcomes.iterations[b]);
    stats.failed.add(SampleIndex(unit.first.value + b), outcomes.status[b]);
    if (counts(outcomes.status[b], plan_->not_converged())) kept_.push_back(b);
  }
  for (std::size_t r = 0; r < responses_; ++r) {
    for (std::size_t n = 0; n < kept_.size(); ++n) values_[n] = outcomes.responses[r * unit.count + kept_[n]];
    stats.responses.push_back(Moments::of(std::span(values_).first(kept_.size())));
  }
  return stats;
}

}  // namespace poesy
