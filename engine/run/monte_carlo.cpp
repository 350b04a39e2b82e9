#include "engine/run/monte_carlo.h"

#include "engine/random/stream.h"
#include "engine/run/counts.h"

namespace poesy {

void ResponseSamples::merge(const ResponseSamples& other) {
  moments.merge(other.moments);
  sketch.merge(other.sketch);
}

void ResponseSamples::write(ByteWriter& to) const {
  moments.write(to);
  sketch.write(to);
}

ResponseSamples ResponseSamples::read(ByteReader& from) {
  ResponseSamples samples;
  samples.moments = Moments::read(from);
  samples.sketch = QuantileSketch::read(from);
  return samples;
}

void PoseUnit::merge(const PoseUnit& other) {
  if (responses.empty()) responses.resize(other.responses.size());
  for (std::size_t r = 0; r < responses.size(); ++r) responses[r].merge(other.responses[r]);
  solves.merge(other.solves);
}

void PoseUnit::write(ByteWriter& to) const {
  for (const ResponseSamples& response : responses) response.write(to);
  solves.write(to);
}

PoseUnit PoseUnit::read(ByteReader& from, std::size_t responses) {
  PoseUnit unit;
  for (std::size_t r = 0; r < responses; ++r) unit.responses.push_back(ResponseSamples::read(from));
  unit.solves = SolveCounts::read(from);
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

void PoseUnitEvaluator::draw(const WorkUnit& unit) {
  for (std::size_t v = 0; v < plan_->factors().size(); ++v) {
    const std::span row = std::span(values_).subspan(v * unit.count, unit.count);
    fill_uniforms({plan_->seed(), Purpose::error_samples, plan_->factors()[v], unit.pose}, unit.first, row);
    plan_->distributions()[v].transform(row);
  }
}

PoseUnit PoseUnitEvaluator::operator()(const WorkUnit& unit) {
  draw(unit);
  const std::span status = std::span(status_).first(unit.count);
  const std::span iterations = std::span(iterations_).first(unit.count);
  evaluator_->evaluate({plan_->poses()[unit.pose], plan_->background(), plan_->factors(),
                        std::span(values_).first(plan_->factors().size() * unit.count), unit.count},
                       {std::span(outcome_).first(responses_ * unit.count), status, iterations, {}});
  PoseUnit found;
  for (std::size_t b = 0; b < unit.count; ++b) found.solves.add(status[b], iterations[b]);
  found.responses.resize(responses_);
  for (std::size_t r = 0; r < responses_; ++r) {
    kept_.clear();
    for (std::size_t b = 0; b < unit.count; ++b) {
      if (counts(status[b], plan_->not_converged())) kept_.push_back(outcome_[r * unit.count + b]);
    }
    found.responses[r].moments = Moments::of(kept_);
    found.responses[r].sketch.add(kept_);
  }
  return found;
}

}  // namespace poesy
