#include "engine/run/pose_unit.h"

#include "engine/random/stream.h"
#include "engine/run/counts.h"

namespace poesy {

void PoseUnit::write(ByteWriter& to) const {
  for (const ResponseUnit& response : responses) {
    response.moments.write(to);
    response.values.write(to);
  }
  solves.write(to);
  failed.write(to);
}

PoseUnit PoseUnit::read(ByteReader& from, std::size_t responses, std::uint64_t first) {
  PoseUnit unit;
  unit.responses.resize(responses);
  for (ResponseUnit& response : unit.responses) {
    response.moments = Moments::read(from);
    response.values = BucketedValues::read(from);
  }
  unit.solves = SolveCounts::read(from);
  unit.failed = FailedSamples::read(from, unit.solves.not_converged(), first, first + unit.solves.total());
  return unit;
}

PoseUnitEvaluator::PoseUnitEvaluator(const Plan& plan, const Model& model)
    : plan_(&plan),
      responses_(model.description().responses.size()),
      evaluator_(model.evaluator(plan.solver())),
      values_(plan.factors().size() * Plan::kUnitSamples),
      outcome_(responses_ * Plan::kUnitSamples),
      status_(Plan::kUnitSamples),
      iterations_(Plan::kUnitSamples) {
  kept_.reserve(Plan::kUnitSamples);
}

std::span<const double> PoseUnitEvaluator::draw(const WorkUnit& unit) {
  for (std::size_t v = 0; v < plan_->factors().size(); ++v) {
    const std::span row = std::span(values_).subspan(v * unit.count, unit.count);
    fill_uniforms({plan_->seed(), Purpose::error_samples, plan_->factors()[v], unit.pose}, unit.first, row);
    plan_->distributions()[v].transform(row);
  }
  return std::span(values_).first(plan_->factors().size() * unit.count);
}

std::span<const double> PoseUnitEvaluator::only_counting(std::span<const double> outcomes,
                                                         std::span<const SolveStatus> status) {
  kept_.clear();
  for (std::size_t b = 0; b < outcomes.size(); ++b) {
    if (counts(status[b], plan_->not_converged())) kept_.push_back(outcomes[b]);
  }
  return kept_;
}

UnitOutcomes PoseUnitEvaluator::solve(const WorkUnit& unit) {
  const std::span values = draw(unit);
  const std::span outcome = std::span(outcome_).first(responses_ * unit.count);
  const std::span status = std::span(status_).first(unit.count);
  const std::span iterations = std::span(iterations_).first(unit.count);
  evaluator_->evaluate({plan_->poses()[unit.pose], plan_->background(), plan_->factors(), values, unit.count},
                       {outcome, status, iterations, {}});
  return {values, outcome, status, iterations};
}

PoseUnit PoseUnitEvaluator::operator()(const WorkUnit& unit) {
  const UnitOutcomes outcomes = solve(unit);
  PoseUnit found;
  std::size_t counting = 0;
  for (std::size_t b = 0; b < unit.count; ++b) {
    found.solves.add(outcomes.status[b], outcomes.iterations[b]);
    found.failed.add(SampleIndex(unit.first.value + b), outcomes.status[b]);
    counting += counts(outcomes.status[b], plan_->not_converged()) ? 1 : 0;
  }
  found.responses.reserve(responses_);
  for (std::size_t r = 0; r < responses_; ++r) {
    std::span<const double> kept = outcomes.responses.subspan(r * unit.count, unit.count);
    if (counting != unit.count) kept = only_counting(kept, outcomes.status);
    found.responses.push_back({Moments::of(kept), BucketedValues(kept)});
  }
  return found;
}

}  // namespace poesy
