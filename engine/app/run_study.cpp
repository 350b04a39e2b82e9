#include "engine/app/run_study.h"

#include <fmt/format.h>

#include <cstdio>

#include "engine/app/exit_code.h"
#include "engine/app/facts.h"
#include "engine/app/failure_limit.h"
#include "engine/app/limits.h"
#include "engine/io/result_file.h"
#include "engine/io/shard_file.h"
#include "engine/run/cases.h"
#include "engine/run/coupling.h"
#include "engine/run/fidelity.h"
#include "engine/run/linearity.h"
#include "engine/run/points_radius.h"
#include "engine/run/separation.h"
#include "engine/run/verdict.h"

namespace poesy::app {
namespace {

/// Once all solves are done.
Ended ended(const Job& job) {
  const RunTime time = job.time();
  const SolveCounts& solves = job.checkpoints().solves();
  Ended ended{solves, run_facts(time.wall, job.threads, solves.total())};
  ended.facts.checkpoint_seconds = time.checkpoints;
  ended.facts.ranks = job.ranks;
  return ended;
}

std::vector<Dimension> response_dimensions(const ModelDescription& model) {
  std::vector<Dimension> dimensions;
  for (const Response& response : model.responses) dimensions.push_back(response.dimension);
  return dimensions;
}

// Each runs a study of its kind and writes the result. Nothing when it was interrupted, and for a shard, which has no
// result of its own. Those whose limits may be stated return what became of them.

/// The study at both of its fidelities, on the same draws.
std::optional<SensitivityResult> run_both_fidelities(const Job& job, const Plan& plan) {
  const Analysis& analysis = job.study.analysis;
  // Progress is that of both as one run. A first half that reports none was done by the run that is continued.
  std::optional<std::uint64_t> before;
  RunOptions options = job.options;
  options.progress = [&](const Progress& half) {
    before = half.before;
    job.options.progress({half.solves, 2 * half.total, half.not_converged, half.before});
  };
  auto first = run_sensitivity(plan, job.model, analysis.conf_level, options);
  if (!job.checkpoints().complete()) return std::nullopt;
  const SolveCounts solves = job.checkpoints().solves();
  options.progress = [&](const Progress& half) {
    job.options.progress({solves.total() + half.solves, solves.total() + half.total,
                          solves.not_converged() + half.not_converged, before.value_or(solves.total()) + half.before});
  };
  const std::unique_ptr<Model> other = build_model(at_compared_fidelity(job.study.mechanism));
  const auto second = run_sensitivity(plan, *other, analysis.conf_level, options);
  if (!first || !second) return std::nullopt;
  first->fidelity = compare_fidelities(*first, *second, response_dimensions(job.study.model()),
                                       standard_deviations(job.study), analysis.linearity);
  return first;
}

void run_sensitivity_study(const Job& job) {
  const Plan plan(job.study, job.poses.poses);
  auto result = job.study.mechanism.compared
                    ? run_both_fidelities(job, plan)
                    : run_sensitivity(plan, job.model, job.study.analysis.conf_level, job.options);
  if (!result) return;
  auto changes = index_changes(plan, job.model, job.options);
  if (!changes) return job.checkpoints().stopped_after_stages();
  if (!job.writes()) return;
  result->index_change = *std::move(changes);
  result->radius_tau = radius_rank_correlations(job.study, plan);
  if (job.model.description().separation) {
    result->separation = separate_errors(job.model, plan.poses(), plan.factors(), standard_deviations(job.study));
  }
  write_sensitivity(job.path, job.study, job.poses, *result, ended(job).facts);
}

void run_identification_study(const Job& job) {
  const auto result = run_identification(job.study, job.model, job.poses.poses, job.options);
  if (result && job.writes()) write_identification(job.path, job.study, job.poses, *result, ended(job).facts);
}

std::optional<LimitVerdicts> run_cases_study(const Job& job) {
  auto evaluation = run_evaluation(job.model, job.study.solver, job.poses.poses, case_table(job.study.analysis.cases),
                                   Pairing::every_pose_with_every_row, job.options);
  if (!evaluation || !job.writes()) return std::nullopt;
  if (const auto& limits = job.study.analysis.limits; !limits.empty()) {
    evaluation->verdicts = judge_rows(limits, *evaluation, Pairing::every_pose_with_every_row, job.study.not_converged);
  }
  const CaseResult result = case_result(std::move(*evaluation), job.study.not_converged);
  write_cases(job.path, job.study, job.poses, result, ended(job).facts);
  return result.evaluation.verdicts;
}

std::optional<LimitVerdicts> run_monte_carlo_study(const Job& job) {
  const Plan plan(job.study, job.poses.poses);
  const auto result = run_monte_carlo(plan, job.model, job.study.analysis, job.options);
  if (!result || !job.writes()) return std::nullopt;
  write_monte_carlo(job.path, job.study, job.poses, *result, ended(job).facts);
  return result->verdicts;
}

void run_coupling_study(const Job& job) {
  const CouplingStudy& coupling = job.study.analysis.coupling;
  const ModelDescription& model = job.model.description();
  const auto evaluation = run_evaluation(job.model, job.study.solver, job.poses.poses, coupling_table(coupling, model),
                                         Pairing::every_pose_with_every_row, job.options, Outcomes::responses);
  if (!evaluation || !job.writes()) return;
  const CouplingResult result = coupling_result(*evaluation, coupling, model, job.study.not_converged);
  write_coupling(job.path, job.study, job.poses, result, ended(job).facts);
}

std::optional<LimitVerdicts> run_any(const Job& job) {
  switch (job.study.analysis.kind) {
    case Analysis::Kind::sensitivity:
      run_sensitivity_study(job);
      break;
    case Analysis::Kind::identification:
      run_identification_study(job);
      break;
    case Analysis::Kind::evaluate:
      return run_cases_study(job);
    case Analysis::Kind::monte_carlo:
      return run_monte_carlo_study(job);
    case Analysis::Kind::coupling:
      run_coupling_study(job);
      break;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Ended> run_study(const Job& job) {
  const std::optional<LimitVerdicts> verdicts = run_any(job);
  if (!job.checkpoints().complete()) return std::nullopt;
  Ended end = ended(job);
  end.verdicts = verdicts;
  if (const auto& shard = job.options.shard; shard && job.writes()) {
    write_shard(job.path, job.study, job.poses, *shard, job.checkpoints().stages(), end.facts);
  }
  return end;
}

int report_end(const Job& job, const std::string& study_path, const Ended& ended) {
  const std::string ranks = ended.facts.ranks > 1 ? fmt::format(" of {} ranks", ended.facts.ranks) : std::string();
  std::fputs(fmt::format("{}: {} solves in {:.2f} s on {} {}{}, {} not converged\n", job.path, ended.facts.solves,
                         ended.facts.wall_seconds, ended.facts.threads, ended.facts.threads == 1 ? "thread" : "threads",
                         ranks, ended.solves.not_converged())
                 .c_str(),
             stdout);
  if (job.options.shard) return kDone;  // the whole study is judged
  const std::string remedy = fmt::format("the result is kept; see 'poesy show {}'", job.path);
  const ExitCode limits = judge_limits(with_verdicts(job.study, job.poses, ended.verdicts), study_path, remedy);
  const ExitCode failures = judge_failures(job.study, ended.solves, study_path, remedy);
  return failures != kDone ? failures : limits;  // with so many failures no limit can be trusted
}

}  // namespace poesy::app
