#include "engine/app/run_study.h"

#include "engine/app/facts.h"
#include "engine/io/result_file.h"
#include "engine/run/cases.h"
#include "engine/run/coupling.h"
#include "engine/run/fidelity.h"
#include "engine/run/separation.h"

namespace poesy::app {
namespace {

Ended ended_with(const Job& job, const SolveCounts& solves) {
  const RunTime time = job.kept != nullptr ? job.kept->time() : RunTime();
  Ended ended{solves, run_facts(time.wall, job.options.threads, solves.total())};
  ended.facts.checkpoint_seconds = time.checkpoints;
  if (job.options.team != nullptr) {
    ended.facts.ranks = job.options.team->ranks().size();
    ended.facts.threads = job.options.team->threads();
  }
  return ended;
}

std::vector<Dimension> response_dimensions(const ModelDescription& model) {
  std::vector<Dimension> dimensions;
  for (const Response& response : model.responses) dimensions.push_back(response.dimension);
  return dimensions;
}

// Each runs a study of its kind and writes the result; nothing when it was interrupted.

/// The study at both of its fidelities, on the same draws.
std::optional<SensitivityResult> run_both_fidelities(const Job& job, const Plan& plan, SolveCounts& solves) {
  const Analysis& analysis = job.study.analysis;
  // Progress is that of both as one run. A first half that reports none was done by the run that is continued.
  std::uint64_t before = plan.solves();
  RunOptions options = job.options;
  options.progress = [&](const Progress& half) {
    before = half.before;
    job.options.progress({half.solves, 2 * half.total, half.not_converged, before});
  };
  auto first = run_sensitivity(plan, job.model, analysis.conf_level, options);
  if (!first) return std::nullopt;
  solves = first->total();
  options.progress = [&](const Progress& half) {
    job.options.progress({solves.total() + half.solves, 2 * half.total, solves.not_converged() + half.not_converged,
                          before + half.before});
  };
  const std::unique_ptr<Model> other = build_model(at_compared_fidelity(job.study.mechanism));
  const auto second = run_sensitivity(plan, *other, analysis.conf_level, options);
  if (!second) return std::nullopt;
  solves.merge(second->total());
  first->fidelity = compare_fidelities(*first, *second, response_dimensions(job.study.model()),
                                       standard_deviations(job.study), analysis.linearity);
  return first;
}

std::optional<Ended> run_sensitivity_study(const Job& job) {
  const Plan plan(job.study, job.poses.poses);
  SolveCounts solves;
  auto result = job.study.mechanism.compared
                    ? run_both_fidelities(job, plan, solves)
                    : run_sensitivity(plan, job.model, job.study.analysis.conf_level, job.options);
  if (!result) return std::nullopt;
  if (!result->fidelity) solves = result->total();
  if (job.model.description().separation) {
    result->separation = separate_errors(job.model, plan.poses(), plan.factors(), standard_deviations(job.study));
  }
  const Ended ended = ended_with(job, solves);
  if (job.kept != nullptr) write_sensitivity(job.path, job.study, job.poses, *result, ended.facts);
  return ended;
}

std::optional<Ended> run_identification_study(const Job& job) {
  const auto result = run_identification(job.study, job.model, job.poses.poses, job.options);
  if (!result) return std::nullopt;
  const Ended ended = ended_with(job, result->solves);
  if (job.kept != nullptr) write_identification(job.path, job.study, job.poses, *result, ended.facts);
  return ended;
}

std::optional<Ended> run_cases_study(const Job& job) {
  auto evaluation = run_evaluation(job.model, job.study.solver, job.poses.poses, case_table(job.study.analysis.cases),
                                   Pairing::every_pose_with_every_row, job.options);
  if (!evaluation) return std::nullopt;
  const Ended ended = ended_with(job, evaluation->total());
  if (job.kept != nullptr)
    write_cases(job.path, job.study, job.poses, case_result(std::move(*evaluation), job.study.not_converged),
                ended.facts);
  return ended;
}

std::optional<Ended> run_monte_carlo_study(const Job& job) {
  const Plan plan(job.study, job.poses.poses);
  const auto result = run_monte_carlo(plan, job.model, job.study.analysis, job.options);
  if (!result) return std::nullopt;
  const Ended ended = ended_with(job, result->total());
  if (job.kept != nullptr) write_monte_carlo(job.path, job.study, job.poses, *result, ended.facts);
  return ended;
}

std::optional<Ended> run_coupling_study(const Job& job) {
  const CouplingStudy& coupling = job.study.analysis.coupling;
  const ModelDescription& model = job.model.description();
  const auto evaluation = run_evaluation(job.model, job.study.solver, job.poses.poses, coupling_table(coupling, model),
                                         Pairing::every_pose_with_every_row, job.options, Outcomes::responses);
  if (!evaluation) return std::nullopt;
  const CouplingResult result = coupling_result(*evaluation, coupling, model, job.study.not_converged);
  const Ended ended = ended_with(job, result.total());
  if (job.kept != nullptr) write_coupling(job.path, job.study, job.poses, result, ended.facts);
  return ended;
}

}  // namespace

std::optional<Ended> run_study(const Job& job) {
  switch (job.study.analysis.kind) {
    case Analysis::Kind::sensitivity:
      return run_sensitivity_study(job);
    case Analysis::Kind::identification:
      return run_identification_study(job);
    case Analysis::Kind::evaluate:
      return run_cases_study(job);
    case Analysis::Kind::monte_carlo:
      return run_monte_carlo_study(job);
    case Analysis::Kind::coupling:
      break;
  }
  return run_coupling_study(job);
}

}  // namespace poesy::app
