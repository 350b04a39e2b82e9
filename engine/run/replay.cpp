#include "engine/run/replay.h"

#include "engine/base/contract.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/evaluation.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

ReplayedSample sample_of(const UnitOutcomes& outcomes, std::vector<FactorIndex> varied, std::vector<double> errors) {
  ReplayedSample sample;
  sample.varied = std::move(varied);
  sample.values.assign(outcomes.values.begin(), outcomes.values.end());
  sample.errors = std::move(errors);
  for (std::size_t v = 0; v < sample.varied.size(); ++v) sample.errors[sample.varied[v].value] = sample.values[v];
  sample.responses.assign(outcomes.responses.begin(), outcomes.responses.end());
  sample.status = outcomes.status[0];
  sample.iterations = outcomes.iterations[0];
  return sample;
}

}  // namespace

ReplayedSample replay_sample(const Study& study, const Model& model, const PoseSet& poses, std::size_t slot,
                             PoseIndex pose, SampleIndex sample) {
  const Plan plan(study, poses);
  POESY_EXPECTS(slot < plan.slots() && pose.value < poses.size() && sample.value < plan.samples());
  const WorkUnit unit{slot, pose, sample, 1};
  std::vector<double> errors(plan.background().begin(), plan.background().end());
  if (study.analysis.kind->varies == Varies::together) {
    PoseUnitEvaluator evaluator(plan, model);
    return sample_of(evaluator.solve(unit), {plan.factors().begin(), plan.factors().end()}, std::move(errors));
  }
  UnitEvaluator evaluator(plan, model);
  return sample_of(evaluator.solve(unit), {plan.factors()[slot]}, std::move(errors));
}

ReplayedSample replay_row(const SolverOptions& solver, const Model& model, const PoseSet& poses, PoseIndex pose,
                          const ErrorTable& row) {
  POESY_EXPECTS(pose.value < poses.size() && row.rows == 1);
  const std::span<const double> before = poses.before(pose);
  std::vector<double> both(before.begin(), before.end());
  both.insert(both.end(), poses[pose].begin(), poses[pose].end());
  const PoseSet last(poses.coordinates(), std::move(both));
  const auto found =
      run_evaluation(model, solver, last, row, Pairing::every_pose_with_every_row, {1, {}, {}}, Outcomes::responses);
  const std::size_t m = last.size() - 1;
  std::vector<double> responses;
  for (std::size_t r = 0; r < found->responses(); ++r) responses.push_back(found->response(r, m, 0));
  return sample_of({row.values, responses, found->status.row(m), found->iterations.row(m)}, row.factors,
                   std::vector<double>(model.description().factors.size(), 0.0));
}

}  // namespace poesy
