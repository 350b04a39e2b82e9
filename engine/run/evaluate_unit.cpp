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
}

void UnitStats::write(ByteWriter& to) const {
  for (const Moments& moments : responses) moments.write(to);
  solves.write(to);
}

UnitStats UnitStats::read(ByteReader& from, std::size_t responses) {
  UnitStats stats;
  for (std::size_t r = 0; r < responses; ++r) stats.responses.push_back(Moments::read(from));
  stats.solves = SolveCounts::read(from);
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

UnitStats UnitEvaluator::operator()(const WorkUnit& unit) {
  const std::span values = std::span(values_).first(unit.count);
  const std::span outcome = std::span(outcome_).first(responses_ * unit.count);
  const FactorIndex factor = plan_->factors()[unit.slot];
  fill_uniforms({plan_->seed(), Purpose::error_samples, factor, unit.pose}, unit.first, values);
  plan_->distributions()[unit.slot].transform(values);
  evaluator_->evaluate({plan_->poses()[unit.pose], plan_->background(), std::span(&factor, 1), values, unit.count,
                        expected_range(plan_->distributions()[unit.slot])},
                       {outcome, std::span(status_).first(unit.count), std::span(iterations_).first(unit.count), {}});
  UnitStats stats;
  stats.responses.reserve(responses_);
  kept_.clear();
  for (std::size_t b = 0; b < unit.count; ++b) {
    stats.solves.add(status_[b], iterations_[b]);
    if (counts(status_[b], plan_->not_converged())) kept_.push_back(b);
  }
  for (std::size_t r = 0; r < responses_; ++r) {
    for (std::size_t n = 0; n < kept_.size(); ++n) values_[n] = outcome[r * unit.count + kept_[n]];
    stats.responses.push_back(Moments::of(std::span(values_).first(kept_.size())));
  }
  return stats;
}

}  // namespace poesy
