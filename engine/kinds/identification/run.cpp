#include "engine/kinds/identification/run.h"
#include "engine/kinds/identification/options.h"
#include "engine/run/evaluation.h"

#include <utility>

namespace poesy {
namespace {

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  auto result = run_identification(run.study, run.model, run.poses, run.options);
  if (!result || !run.makes_result()) return std::nullopt;
  return StudyResult{*std::move(result), std::nullopt, {}};
}

Outlook identification_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const std::size_t errors = study.analysis.factors.size();
  const std::size_t groups = asked_of<IdentificationOptions>(study.analysis).groups.size();
  const std::size_t solves = errors * groups * poses.size();
  const std::size_t outcomes = solves * outcome_bytes(study.model(), Outcomes::responses);
  return {.solves = counted_things(errors, "errors x ") + counted_things(groups, "groups x ") +
                    counted_things(poses.size(), "poses = ") + counted_things(solves, "solves, and more for couplings"),
          .memory = {.accumulators = outcomes, .state = outcomes},
          .shared = {table_work(
              poses,
              [&](const PoseSet& some) { static_cast<void>(run_identification(study, model, some, {.threads = 1})); })},
          .by_one = {}};
}

}  // namespace

std::optional<IdentificationResult> run_identification(const Study& study, const Model& model, const PoseSet& poses,
                                                       const RunOptions& options) {
  return identify(study.analysis, model.description(), [&](const ErrorTable& errors) {
    return run_evaluation(model, study.solver, poses, errors, Pairing::every_pose_with_every_row, options,
                          Outcomes::responses);
  });
}

constinit const RunKind kIdentificationRun{run_study_of_kind, identification_outlook, nullptr};

}  // namespace poesy
