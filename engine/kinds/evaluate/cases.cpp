#include "engine/kinds/evaluate/cases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/kinds/evaluate/kind.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"

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
  return {.solves = counted_things(table.rows, "cases x ") + counted_things(poses.size(), "poses = ") +
                    counted_things(solves, "solves"),
          .memory = {.state = outcomes, .result = outcomes, .file = outcomes},
          .shared = {table_work(study, model, poses, table, Outcomes::with_details)},
          .by_one = {}};
}

}  // namespace

ErrorTable case_table(std::span<const ErrorCase> cases) {
  ErrorTable table;
  table.rows = cases.size();
  if (cases.empty()) return table;
  for (std::size_t f = 0; f < cases.front().errors.size(); ++f) table.factors.emplace_back(f);
  for (const ErrorCase& one : cases) table.values.insert(table.values.end(), one.errors.begin(), one.errors.end());
  return table;
}

CaseResult case_result(EvaluationResult evaluation, NotConverged policy) {
  CaseResult result;
  const std::size_t cases = evaluation.samples;
  const std::size_t all = evaluation.poses * cases;
  for (std::size_t r = 0; r < evaluation.responses; ++r) {
    for (std::size_t c = 0; c < cases; ++c) {
      std::uint64_t count = 0;
      double sum = 0.0;
      double largest = -std::numeric_limits<double>::infinity();
      for (std::size_t m = 0; m < evaluation.poses; ++m) {
        if (!counts(evaluation.status[m * cases + c], policy)) continue;
        const double value = evaluation.response[r * all + m * cases + c];
        sum += value;
        largest = std::max(largest, value);
        ++count;
      }
      result.count.push_back(count);
      result.mean.push_back(count == 0 ? kNaN : sum / static_cast<double>(count));
      result.max.push_back(count == 0 ? kNaN : largest);
    }
  }
  result.evaluation = std::move(evaluation);
  return result;
}

std::vector<RowOutcome> row_outcomes(const StoredEvaluation& stored, std::size_t response) {
  const EvaluationResult& found = stored.evaluation;
  const std::size_t solves = found.status.size();
  std::vector<RowOutcome> rows(stored.labels.names.size());
  for (std::size_t at = 0; at < solves; ++at) {
    if (!solved(found.status[at])) continue;
    const double value = found.response[response * solves + at];
    RowOutcome& row = rows[row_of_solve(stored, at)];
    if (row.solved == 0) row.mean = row.extreme = 0.0;
    row.mean += value;  // their sum, until all are there
    if (row.solved == 0 || std::abs(value) > std::abs(row.extreme)) {
      row.extreme = value;
      row.pose = at / found.samples;
    }
    ++row.solved;
  }
  for (RowOutcome& row : rows) row.mean /= static_cast<double>(row.solved);
  return rows;
}

std::size_t worst_row(const std::vector<RowOutcome>& outcomes) {
  std::size_t worst = outcomes.size();
  for (std::size_t row = 0; row < outcomes.size(); ++row) {
    if (outcomes[row].solved == 0) continue;
    if (worst == outcomes.size() || std::abs(outcomes[row].extreme) > std::abs(outcomes[worst].extreme)) worst = row;
  }
  return worst;
}

constinit const Kind kEvaluateKind{.study = kEvaluateStudy,
                                   .run = {run_study_of_kind, cases_outlook, shards_by_pose},
                                   .file = kEvaluationFile,
                                   .report = kEvaluationReport,
                                   .given_errors = evaluated_errors};

}  // namespace poesy
