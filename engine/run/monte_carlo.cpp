#include "engine/run/monte_carlo.h"

#include <limits>
#include <utility>

#include "engine/base/contract.h"
#include "engine/random/stream.h"
#include "engine/run/counts.h"
#include "engine/stats/mean_interval.h"

namespace poesy {
namespace {

/// NaN where nothing counts.
double mean_of(const Moments& moments) {
  return moments.count() == 0 ? std::numeric_limits<double>::quiet_NaN() : moments.mean();
}

}  // namespace

void ResponseSamples::merge(const ResponseSamples& other) {
  moments.merge(other.moments);
  sketch.merge(other.sketch);
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

std::span<const double> PoseUnitEvaluator::only_counting(std::span<const double> outcomes,
                                                         std::span<const SolveStatus> status) {
  kept_.clear();
  for (std::size_t b = 0; b < outcomes.size(); ++b) {
    if (counts(status[b], plan_->not_converged())) kept_.push_back(outcomes[b]);
  }
  return kept_;
}

PoseUnit PoseUnitEvaluator::operator()(const WorkUnit& unit) {
  draw(unit);
  const std::span status = std::span(status_).first(unit.count);
  const std::span iterations = std::span(iterations_).first(unit.count);
  evaluator_->evaluate({plan_->poses()[unit.pose], plan_->background(), plan_->factors(),
                        std::span(values_).first(plan_->factors().size() * unit.count), unit.count},
                       {std::span(outcome_).first(responses_ * unit.count), status, iterations, {}});
  PoseUnit found;
  std::size_t counting = 0;
  for (std::size_t b = 0; b < unit.count; ++b) {
    found.solves.add(status[b], iterations[b]);
    counting += counts(status[b], plan_->not_converged()) ? 1 : 0;
  }
  found.responses.reserve(responses_);
  for (std::size_t r = 0; r < responses_; ++r) {
    std::span<const double> kept = std::span(outcome_).subspan(r * unit.count, unit.count);
    if (counting != unit.count) kept = only_counting(kept, status);
    found.responses.push_back({Moments::of(kept), BucketedValues(kept)});
  }
  return found;
}

MonteCarloCollector::MonteCarloCollector(const Plan& plan, std::size_t responses, const Analysis& analysis)
    : samples_(plan.samples()), at_pose_(responses), overall_(responses) {
  result_.responses = responses;
  result_.poses = plan.poses().size();
  result_.conf_level = analysis.conf_level;
  result_.quantile_relative_error = QuantileSketch::kRelativeError;
  result_.levels = analysis.quantiles;
  const std::size_t cells = responses * result_.poses;
  for (auto* values :
       {&result_.mean, &result_.mean_ci_low, &result_.mean_ci_high, &result_.std, &result_.min, &result_.max}) {
    values->resize(cells);
  }
  result_.count.resize(cells);
  result_.quantiles.resize(cells * result_.levels.size());
  result_.solves.resize(result_.poses);
}

void MonteCarloCollector::add(PoseIndex pose, const PoseUnit& unit) {
  POESY_EXPECTS(pose == pose_ || solves_at_pose_.total() == 0);
  pose_ = pose;
  for (std::size_t r = 0; r < overall_.size(); ++r) {
    at_pose_[r].moments.merge(unit.responses[r].moments);
    at_pose_[r].sketch.add(unit.responses[r].values);
  }
  solves_at_pose_.merge(unit.solves);
  if (solves_at_pose_.total() == samples_) finish_pose();
}

void MonteCarloCollector::finish_pose() {
  for (std::size_t r = 0; r < overall_.size(); ++r) {
    const auto& [moments, sketch] = at_pose_[r];
    const std::size_t cell = r * result_.poses + pose_.value;
    const Interval interval = mean_interval(moments, result_.conf_level);
    result_.mean[cell] = mean_of(moments);
    result_.mean_ci_low[cell] = interval.low;
    result_.mean_ci_high[cell] = interval.high;
    result_.std[cell] = moments.standard_deviation();
    result_.min[cell] = sketch.min();
    result_.max[cell] = sketch.max();
    result_.count[cell] = moments.count();
    for (std::size_t q = 0; q < result_.levels.size(); ++q) {
      result_.quantiles[cell * result_.levels.size() + q] = sketch.quantile(result_.levels[q]);
    }
    overall_[r].merge(at_pose_[r]);
  }
  result_.solves[pose_.value] = solves_at_pose_;
  at_pose_.assign(overall_.size(), {});
  solves_at_pose_ = {};
}

MonteCarloResult MonteCarloCollector::result() && {
  for (const auto& [moments, sketch] : overall_) {
    result_.overall_mean.push_back(mean_of(moments));
    result_.overall_std.push_back(moments.standard_deviation());
    result_.overall_min.push_back(sketch.min());
    result_.overall_max.push_back(sketch.max());
    result_.overall_count.push_back(moments.count());
    for (const double level : result_.levels) result_.overall_quantiles.push_back(sketch.quantile(level));
  }
  return std::move(result_);
}

}  // namespace poesy
