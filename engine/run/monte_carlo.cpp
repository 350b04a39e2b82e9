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

MonteCarloCollector::MonteCarloCollector(const Plan& plan, std::size_t responses, const Analysis& analysis)
    : samples_(plan.samples()), overall_(responses) {
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
  at_pose_.responses.resize(responses);
}

void MonteCarloCollector::add(PoseIndex pose, const PoseUnit& unit) {
  POESY_EXPECTS(pose == pose_ || at_pose_.solves.total() == 0);
  pose_ = pose;
  for (std::size_t r = 0; r < overall_.size(); ++r) at_pose_.responses[r].merge(unit.responses[r]);
  at_pose_.solves.merge(unit.solves);
  if (at_pose_.solves.total() == samples_) finish_pose();
}

void MonteCarloCollector::finish_pose() {
  for (std::size_t r = 0; r < overall_.size(); ++r) {
    const auto& [moments, sketch] = at_pose_.responses[r];
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
    overall_[r].merge(at_pose_.responses[r]);
  }
  result_.solves[pose_.value] = at_pose_.solves;
  at_pose_ = {.responses = std::vector<ResponseSamples>(overall_.size()), .solves = {}};
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
