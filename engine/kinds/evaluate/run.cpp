#include "engine/kinds/evaluate/run.h"

#include <utility>

#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/evaluate/options.h"
#include "engine/run/evaluation.h"
#include "engine/run/verdict.h"

namespace poesy {
namespace {

constexpr Pairing kPairing = Pairing::every_pose_with_every_row;

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  auto evaluation = run_evaluation(run.model, run.study.solver, run.poses,
                                   case_table(asked_of<CaseOptions>(run.study.analysis).cases), kPairing, run.options);
  if (!evaluation || !run.makes_result()) return std::nullopt;
  if (const auto& limits = run.study.analysis.limits; !limits.empty()) {
    evaluation->verdicts = judge_rows(limits, *evaluation, kPairing, run.study.not_converged);
  }
  StudyResult found{{}, evaluation->verdicts, {}};
  for (const ErrorCase& one : asked_of<CaseOptions>(run.study.analysis).cases) found.row_names.push_back(one.name);
  found.found = case_result(std::move(*evaluation), run.study.not_converged);
  return found;
}

Outlook cases_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const ErrorTable table = case_table(asked_of<CaseOptions>(study.analysis).cases);
  const std::size_t solves = table.rows * poses.size();
  const std::size_t outcomes = solves * outcome_bytes(study.model(), Outcomes::with_details);
  // The file has cases before poses: a transposed copy of the outcomes.
  return {.solves = counted_things(table.rows, "cases x ") + counted_things(poses.size(), "poses = ") +
                    counted_things(solves, "solves"),
          .memory = {.accumulators = outcomes, .state = outcomes, .result = outcomes, .file = outcomes},
          .shared = {table_work(study, model, poses, table, Outcomes::with_details)},
          .by_one = {}};
}

}  // namespace

constinit const RunKind kCasesRun{run_study_of_kind, cases_outlook, shards_by_pose};

}  // namespace poesy
