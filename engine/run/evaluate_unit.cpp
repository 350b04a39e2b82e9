#include "engine/run/evaluate_unit.h"

#include <array>
#include <cmath>

#include "engine/base/array.h"
#include "engine/base/contract.h"
#include "engine/random/stream.h"
#include "engine/run/effect_poses.h"

namespace poesy {
namespace {

/// The largest magnitude to expect of an error: |mean| plus four standard deviations, which about one of 16 000 normal
/// draws exceeds, but not more than the largest value of the distribution.
double expected_range(const Distribution& distribution) {
  return std::min(distribution.largest(), std::abs(distribution.mean()) + 4.0 * distribution.standard_deviation());
}

/// Adds the status and the iterations of each sample of a unit to the counts in `found`.
template <class Unit>
void count_ends(const WorkUnit& unit, const UnitOutcomes& outcomes, Unit& found) {
  for (std::size_t b = 0; b < unit.count; ++b) {
    found.solves.add(outcomes.status[b], outcomes.iterations[b]);
    found.failed.add(SampleIndex(unit.first.value + b), outcomes.status[b]);
  }
}

}  // namespace

void UnitStats::merge(const UnitStats& other) {
  if (responses.empty()) responses.resize(other.responses.size());
  for (std::size_t r = 0; r < responses.size(); ++r) responses[r].merge(other.responses[r]);
  solves.merge(other.solves);
  failed.merge(other.failed);
}

void ends_state(Archive& archive, SolveCounts& solves, FailedSamples& failed, std::uint64_t first) {
  archive.object(solves);
  failed.state(archive, solves.not_converged(), first, first + solves.total());
}

void ends_state(Archive& archive, std::span<SolveCounts> solves, std::span<FailedSamples> failed, std::uint64_t count,
                std::uint64_t first, std::uint64_t end) {
  for (std::size_t m = 0; m < solves.size(); ++m) {
    archive.object(solves[m]);
    archive.expect(solves[m].total() == count, "has a pose with other machines");
    failed[m].state(archive, solves[m].not_converged(), first, end);
  }
}

void UnitStats::state(Archive& archive, std::uint64_t first) {
  archive.object(responses);
  ends_state(archive, solves, failed, first);
}

void CellUnit::state(Archive& archive, std::uint64_t first) {
  UnitStats::state(archive, first);
  archive.object(within);
}

void PoseUnit::state(Archive& archive, std::size_t errors, std::uint64_t first) {
  archive.object(responses);
  ends_state(archive, solves, failed, first);
  archive.optional(effects, errors, responses.size());
}

std::vector<std::size_t> history_points(const Plan& plan) {
  std::vector<std::size_t> points;
  if (plan.adaptive()) return points;
  for (std::size_t left = plan.samples() / 100, decade = 100; left > 0; left /= 10, decade *= 10) {
    for (const std::size_t step : {1U, 2U, 5U}) {
      if (step <= left) points.push_back(step * decade);
    }
  }
  return points;
}

std::span<const std::size_t> points_within(const WorkUnit& unit, std::span<const std::size_t> points) {
  if (unit.first.value > 0) return {};
  return points.first(static_cast<std::size_t>(std::ranges::lower_bound(points, unit.count) - points.begin()));
}

UnitSolver::UnitSolver(const Plan& plan, const Model& model, std::size_t varied)
    : plan_(&plan),
      responses_(model.description().responses.size()),
      values_(varied * Plan::kUnitSamples),
      evaluator_(model.evaluator(plan.solver())),
      outcome_(responses_ * Plan::kUnitSamples),
      status_(Plan::kUnitSamples),
      iterations_(Plan::kUnitSamples) {}

void UnitSolver::draw_uniforms(const WorkUnit& unit, std::size_t slot, std::span<double> row) const {
  plan_->draw_uniforms(slot, unit.pose, unit.first, row);
}

EffectBins UnitSolver::draw_in_bins(const WorkUnit& unit) {
  const std::size_t errors = plan_->factors().size();
  const std::span<double> values = std::span(values_).first(errors * unit.count);
  for (std::size_t v = 0; v < errors; ++v) draw_uniforms(unit, v, values.subspan(v * unit.count, unit.count));
  EffectBins bins(values, errors);
  plan_->transform(values, unit.count);
  return bins;
}

void UnitSolver::draw_per_pose(const WorkUnit& unit) {
  const std::span<double> values = std::span(values_).first(plan_->factors().size() * unit.count);
  for (const std::size_t v : plan_->per_pose()) draw_uniforms(unit, v, values.subspan(v * unit.count, unit.count));
  plan_->transform_per_pose(values, unit.count);
}

SampleBlock UnitSolver::drawn(std::size_t count) const {
  const std::span<const FactorIndex> factors = plan_->factors();
  return {.pose = {},
          .errors = plan_->background(),
          .varied = factors,
          .values = std::span(values_).first(factors.size() * count),
          .count = count};
}

UnitOutcomes UnitSolver::solve(PoseIndex pose, std::span<const FactorIndex> varied, std::size_t count, double range,
                               std::span<double> details) {
  const std::span values = std::span(values_).first(varied.size() * count);
  const std::span outcome = std::span(outcome_).first(responses_ * count);
  const std::span status = std::span(status_).first(count);
  const std::span iterations = std::span(iterations_).first(count);
  const PoseSet& poses = plan_->poses();
  Evaluator& evaluator = other_ == nullptr ? *evaluator_ : *other_;
  evaluator.evaluate({poses[pose], plan_->background(), varied, values, count, range, poses.before(pose)},
                     {outcome, status, iterations, details});
  return {values, outcome, status, iterations};
}

UnitEvaluator::UnitEvaluator(const Plan& plan, const Model& model)
    : UnitSolver(plan, model, 1), points_(history_points(plan)) {}

UnitOutcomes UnitEvaluator::solve(const WorkUnit& unit) { return solve(unit, std::array{1.0}); }

UnitOutcomes UnitEvaluator::solve(const WorkUnit& unit, std::span<const double> scales) {
  const std::size_t count = scales.size() * unit.count;
  POESY_EXPECTS(count <= Plan::kUnitSamples);
  const std::span draws = std::span(values_).first(unit.count);
  draw_uniforms(unit, unit.slot, draws);
  plan_->distributions()[unit.slot].transform(draws);
  const ArrayView<double, Axis<"scale">, axis::Sample> scaled{std::span(values_).first(count),
                                                              {scales.size(), unit.count}};
  // Goes backwards: row 0 contains the draws, from which all rows are computed, so it must be overwritten last.
  for (std::size_t k = scales.size(); k-- > 0;) {
    for (std::size_t b = 0; b < unit.count; ++b) scaled(k, b) = scales[k] * draws[b];
  }
  return UnitSolver::solve(unit.pose, plan_->factors().subspan(unit.slot, 1), count,
                           expected_range(plan_->distributions()[unit.slot]));
}

CellUnit UnitEvaluator::operator()(const WorkUnit& unit) {
  const UnitOutcomes outcomes = solve(unit);
  const std::span<const std::size_t> points = points_within(unit, points_);
  const double sigma = plan_->distributions()[unit.slot].standard_deviation();
  CellUnit found;
  found.responses.reserve(responses_);
  found.within.resize(points.size() * responses_);
  const ArrayView<LocalIndex, Axis<"point">, axis::Response> within(found.within, {points.size(), responses_});
  const ArrayView<const double, axis::Response, axis::Sample> responses(outcomes.responses, {responses_, unit.count});
  count_ends(unit, outcomes, found);
  kept_.clear();
  for (std::size_t b = 0; b < unit.count; ++b) {
    if (counts(outcomes.status[b], plan_->not_converged())) kept_.push_back(b);
  }
  for (std::size_t r = 0; r < responses_; ++r) {
    for (std::size_t n = 0; n < kept_.size(); ++n) values_[n] = responses(r, kept_[n]);
    const std::span<const double> kept = std::span(values_).first(kept_.size());
    found.responses.push_back(Moments::of(kept));
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto count = static_cast<std::size_t>(std::ranges::lower_bound(kept_, points[k]) - kept_.begin());
      within(k, r) = local_index_with_error(Moments::of(kept.first(count)), sigma);
    }
  }
  return found;
}

PoseUnitEvaluator::PoseUnitEvaluator(const Plan& plan, const Model& model)
    : UnitSolver(plan, model, plan.factors().size()),
      effect_poses_(effect_poses(plan.poses().size(), responses_, plan.factors().size())) {
  kept_.reserve(Plan::kUnitSamples);
}

UnitOutcomes PoseUnitEvaluator::solve(const WorkUnit& unit) {
  for (std::size_t v = 0; v < plan_->factors().size(); ++v) {
    draw_uniforms(unit, v, std::span(values_).subspan(v * unit.count, unit.count));
  }
  plan_->transform(std::span(values_).first(plan_->factors().size() * unit.count), unit.count);
  return solve_drawn(unit);
}

UnitOutcomes PoseUnitEvaluator::solve_drawn(const WorkUnit& unit) {
  return UnitSolver::solve(unit.pose, plan_->factors(), unit.count, 0.0);
}

std::span<const double> PoseUnitEvaluator::only_counting(std::span<const double> outcomes,
                                                         std::span<const SolveStatus> status) {
  kept_.clear();
  for (std::size_t b = 0; b < outcomes.size(); ++b) {
    if (counts(status[b], plan_->not_converged())) kept_.push_back(outcomes[b]);
  }
  return kept_;
}

MainEffectSums PoseUnitEvaluator::effects_of(const UnitOutcomes& outcomes, const EffectBins& bins) const {
  std::vector<std::uint8_t> ok;
  for (const SolveStatus status : outcomes.status) ok.push_back(counts(status, plan_->not_converged()) ? 1 : 0);
  MainEffectSums sums(plan_->factors().size(), responses_);
  sums.add(bins, outcomes.responses, ok);
  return sums;
}

PoseUnit PoseUnitEvaluator::operator()(const WorkUnit& unit) {
  const bool has_effects = std::ranges::find(effect_poses_, unit.pose) != effect_poses_.end();
  const std::optional<EffectBins> bins = has_effects ? std::optional(draw_in_bins(unit)) : std::nullopt;
  const UnitOutcomes outcomes = bins ? solve_drawn(unit) : solve(unit);
  PoseUnit found;
  if (bins) found.effects = effects_of(outcomes, *bins);
  count_ends(unit, outcomes, found);
  found.responses.reserve(responses_);
  const bool all_count =
      std::ranges::all_of(outcomes.status, [&](SolveStatus status) { return counts(status, plan_->not_converged()); });
  for (std::size_t r = 0; r < responses_; ++r) {
    const auto all = outcomes.responses.subspan(r * unit.count, unit.count);
    const std::span<const double> kept = all_count ? all : only_counting(all, outcomes.status);
    found.responses.push_back({Moments::of(kept), NumberBlock(kept)});
    found.responses.back().values.sort_few();
  }
  return found;
}

}  // namespace poesy
