#include "engine/kinds/coupling/run.h"

#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/coupling/options.h"
#include "engine/kinds/coupling/rows.h"
#include "engine/run/evaluation.h"

namespace poesy {
namespace {

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  const CouplingStudy& coupling = asked_of<CouplingStudy>(run.study.analysis);
  const ModelDescription& model = run.model.description();
  const auto evaluation = run_evaluation(run.model, run.study.solver, run.poses, coupling_table(coupling, model),
                                         Pairing::every_pose_with_every_row, run.options, Outcomes::responses);
  if (!evaluation || !run.makes_result()) return std::nullopt;
  return StudyResult{coupling_result(*evaluation, coupling, model, run.study.not_converged), std::nullopt, {}};
}

Outlook coupling_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const CouplingStudy& coupling = asked_of<CouplingStudy>(study.analysis);
  const CouplingRows rows = coupling_rows(coupling, study.model());
  const ErrorTable table = coupling_table(coupling, study.model());
  const std::size_t solves = table.rows * poses.size();
  const std::size_t outcomes = solves * outcome_bytes(study.model(), Outcomes::responses);
  const std::size_t cells = coupling.sizes() * poses.size();
  const std::size_t curves = 6 * sizeof(double) * cells * rows.subsets.size() * study.model().responses.size();
  // The state is copied while it grows, and one of the six curves while it is hashed.
  return {.solves = counted_things(coupling.sizes(), "sizes x ") +
                    counted_things(rows.errors.size(), "sets of errors x ") + counted_things(poses.size(), "poses = ") +
                    counted_things(solves, "solves"),
          .memory = {.accumulators = 2 * outcomes + curves / 6,
                     .state = outcomes,
                     .result = curves + cells * sizeof(SolveCounts),
                     .file = curves + cells * kSolverColumns},
          .shared = {table_work(study, model, poses, table, Outcomes::responses)},
          .by_one = {}};
}

}  // namespace

constinit const RunKind kCouplingRun{run_study_of_kind, coupling_outlook, shards_by_pose};

}  // namespace poesy
