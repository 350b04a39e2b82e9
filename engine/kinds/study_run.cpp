#include "engine/kinds/study_run.h"

#include <string>
#include <utility>

#include "engine/base/error.h"
#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/coupling/options.h"
#include "engine/kinds/coupling/rows.h"
#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/evaluate/options.h"
#include "engine/kinds/identification/options.h"
#include "engine/kinds/monte_carlo/options.h"
#include "engine/kinds/sensitivity/fidelity.h"
#include "engine/kinds/sensitivity/linearity.h"
#include "engine/kinds/sensitivity/options.h"
#include "engine/kinds/sensitivity/points_radius.h"
#include "engine/kinds/sensitivity/separation.h"
#include "engine/run/verdict.h"
#include "engine/study/plan.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {
namespace {

/// A study that is run, with the checkpoints that its stages need.
struct StudyRun {
  const Study& study;
  const Model& model;
  const PoseSet& poses;
  const RunOptions& options;

  Checkpoints& checkpoints() const { return *options.checkpoints; }
  /// Whether this process makes the result out of what was solved: of several ranks the first.
  bool makes_result() const { return options.team == nullptr || options.team->leads(); }
};

std::vector<Dimension> response_dimensions(const ModelDescription& model) {
  std::vector<Dimension> dimensions;
  for (const Response& response : model.responses) dimensions.push_back(response.dimension);
  return dimensions;
}

/// The study at both of its fidelities, on the same draws.
std::optional<SensitivityResult> run_both_fidelities(const StudyRun& run, const Plan& plan) {
  const Analysis& analysis = run.study.analysis;
  const auto report = [&](const Progress& progress) {
    if (run.options.progress) run.options.progress(progress);
  };
  // Progress is that of both as one run. A first half that reports none was done by the run that is continued.
  std::optional<std::uint64_t> before;
  RunOptions options = run.options;
  options.progress = [&](const Progress& half) {
    before = half.before;
    report({half.solves, 2 * half.total, half.not_converged, half.before});
  };
  auto first = run_sensitivity(plan, run.model, analysis.conf_level, options);
  if (!run.checkpoints().complete()) return std::nullopt;
  const SolveCounts solves = run.checkpoints().solves();
  options.progress = [&](const Progress& half) {
    report({solves.total() + half.solves, solves.total() + half.total, solves.not_converged() + half.not_converged,
            before.value_or(solves.total()) + half.before});
  };
  const std::unique_ptr<Model> other = build_model(at_compared_fidelity(run.study.mechanism));
  const auto second = run_sensitivity(plan, *other, analysis.conf_level, options);
  if (!first || !second) return std::nullopt;
  first->fidelity =
      compare_fidelities(*first, *second, response_dimensions(run.study.model()), standard_deviations(run.study),
                         asked_of<SensitivityOptions>(analysis).linearity);
  return first;
}

std::optional<StudyResult> run_sensitivity_study(const StudyRun& run) {
  const Plan plan(run.study, run.poses);
  auto result = run.study.mechanism.compared
                    ? run_both_fidelities(run, plan)
                    : run_sensitivity(plan, run.model, run.study.analysis.conf_level, run.options);
  if (!result) return std::nullopt;
  auto changes = index_changes(plan, run.model, run.options);
  if (!changes) {
    run.checkpoints().stopped_after_stages();
    return std::nullopt;
  }
  if (!run.makes_result()) return std::nullopt;
  result->index_change = *std::move(changes);
  result->radius_tau = radius_rank_correlations(run.study, plan);
  if (run.model.description().separation) {
    result->separation = separate_errors(run.model, plan.poses(), plan.factors(), standard_deviations(run.study));
  }
  return result;
}

std::optional<StudyResult> run_identification_study(const StudyRun& run) {
  auto result = run_identification(run.study, run.model, run.poses, run.options);
  if (!result || !run.makes_result()) return std::nullopt;
  return result;
}

std::optional<StudyResult> run_cases_study(const StudyRun& run) {
  constexpr Pairing kPairing = Pairing::every_pose_with_every_row;
  auto evaluation =
      run_evaluation(run.model, run.study.solver, run.poses,
                     case_table(asked_of<CaseOptions>(run.study.analysis).cases), kPairing, run.options);
  if (!evaluation || !run.makes_result()) return std::nullopt;
  if (const auto& limits = run.study.analysis.limits; !limits.empty()) {
    evaluation->verdicts = judge_rows(limits, *evaluation, kPairing, run.study.not_converged);
  }
  return case_result(std::move(*evaluation), run.study.not_converged);
}

std::optional<StudyResult> run_monte_carlo_study(const StudyRun& run) {
  const Plan plan(run.study, run.poses);
  auto result = run_monte_carlo(plan, run.model, run.study.analysis, run.options);
  if (!result || !run.makes_result()) return std::nullopt;
  return result;
}

std::optional<StudyResult> run_coupling_study(const StudyRun& run) {
  const CouplingStudy& coupling = asked_of<CouplingStudy>(run.study.analysis);
  const ModelDescription& model = run.model.description();
  const auto evaluation = run_evaluation(run.model, run.study.solver, run.poses, coupling_table(coupling, model),
                                         Pairing::every_pose_with_every_row, run.options, Outcomes::responses);
  if (!evaluation || !run.makes_result()) return std::nullopt;
  return coupling_result(*evaluation, coupling, model, run.study.not_converged);
}

std::optional<StudyResult> run_kind(const StudyRun& run) {
  const StudyKind* kind = run.study.analysis.kind;
  if (kind == &kSensitivityStudy) return run_sensitivity_study(run);
  if (kind == &kIdentificationStudy) return run_identification_study(run);
  if (kind == &kEvaluateStudy) return run_cases_study(run);
  if (kind == &kMonteCarloStudy) return run_monte_carlo_study(run);
  return run_coupling_study(run);
}

/// Cells or blocks that shards of the study can divide between them.
std::size_t divisible(const Study& study, std::size_t poses) {
  const bool by_factor = study.analysis.kind == &kSensitivityStudy;
  return by_factor ? study.analysis.factors.size() * poses : poses;
}

}  // namespace

std::optional<StudyResult> run_study(const Study& study, const Model& model, const PoseSet& poses,
                                     const RunOptions& options) {
  Checkpoints not_kept([] { return false; }, [](std::span<const Bytes>) {});
  RunOptions with_checkpoints = options;
  if (options.checkpoints == nullptr) with_checkpoints.checkpoints = &not_kept;
  return run_kind({.study = study, .model = model, .poses = poses, .options = with_checkpoints});
}

std::optional<StudyResult> run_study(const Study& study, const RunOptions& options) {
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  return run_study(study, *model, select_poses(study.poses, *model).poses, options);
}

void check_shard(const Shard& shard, const Study& study, std::size_t poses) {
  if (study.analysis.kind == &kIdentificationStudy) {
    throw InputError({}, "--shard divides no identification, each step of which needs all poses of the one before",
                     "run it whole, for it is small, or with mpirun");
  }
  if (study.analysis.adaptive) {
    throw InputError(
        {}, "--shard divides no study with adaptive samples: when an error has enough is decided over all poses",
        "write samples = N, or run it with mpirun");
  }
  if (const std::size_t most = divisible(study, poses); shard.count > most) {
    throw InputError({},
                     "--shard asks for " + std::to_string(shard.count) + " shards, but this study divides into " +
                         std::to_string(most) + " at most",
                     "take fewer shards");
  }
}

std::optional<LimitVerdicts> verdicts_of(const StudyResult& result) {
  if (const auto* cases = std::get_if<CaseResult>(&result)) return cases->evaluation.verdicts;
  if (const auto* draws = std::get_if<MonteCarloResult>(&result)) return draws->verdicts;
  return std::nullopt;
}

}  // namespace poesy
