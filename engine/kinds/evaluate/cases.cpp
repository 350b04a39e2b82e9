#include "engine/kinds/evaluate/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/kinds/calibrated_model.h"
#include "engine/kinds/evaluate/kind.h"
#include "engine/report/display.h"
#include "engine/result/result_parts.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/run/rows_within.h"

namespace poesy::evaluate {
namespace {

constexpr Pairing kPairing = Pairing::every_pose_with_every_row;

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  const std::vector<ErrorCase>& cases = asked_of<CaseOptions>(run.study.analysis).cases;
  const std::shared_ptr<const Model> model = studied_model(run.study, run.model, run.poses);
  auto solves = run_evaluation(*model, run.study.solver, run.poses, case_table(cases), kPairing, run.options);
  if (!solves || !run.makes_result()) return std::nullopt;
  std::vector<std::uint8_t> within;
  if (const auto& limits = run.study.analysis.limits; !limits.empty()) {
    solves->verdicts = judge_rows(limits, *solves, kPairing, run.study.not_converged);
    within = rows_within(limits, *solves, kPairing, run.study.not_converged);
  }
  StudyResult found{{}, solves->verdicts, {}};
  found.row_names = texts(cases, &ErrorCase::name);
  Evaluation judged = evaluation_of_cases(*std::move(solves), cases, run.model.description(), run.study.not_converged);
  judged.within_limits = std::move(within);
  found.found = std::move(judged);
  return found;
}

Outlook cases_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const ErrorTable table = case_table(asked_of<CaseOptions>(study.analysis).cases);
  const std::size_t solves = table.rows * poses.size();
  const std::size_t outcomes = solves * outcome_bytes(study.model(), Outcomes::with_details);
  const auto calibration = machine_calibration(study, model, poses);
  return {.solves = counted_things(table.rows, "cases x ") + counted_things(poses.size(), "poses = ") +
                    counted_things(solves, "solves") + (calibration ? calibration_cost_text(*calibration, "case") : ""),
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

Evaluation evaluation(EvaluationResult solves, const ErrorTable& errors, Pairing pairing,
                      const ModelDescription& model) {
  Evaluation found;
  found.solves = std::move(solves);
  found.details = model.details;
  found.joints = texts(model.joints, &JointDisplacement::name);
  found.pairing = pairing;
  found.errors = decltype(found.errors)({errors.rows, errors.factors.size()}, errors.values);
  found.labels = errors.labels;
  for (std::size_t f = 0; f < model.factors.size(); ++f) {
    if (std::ranges::find(errors.factors, FactorIndex(f)) != errors.factors.end()) continue;
    found.zero_errors.push_back(model.factors[f].name);
  }
  return found;
}

Evaluation evaluation_of_cases(EvaluationResult solves, std::span<const ErrorCase> cases, const ModelDescription& model,
                               NotConverged policy) {
  Evaluation found = evaluation(std::move(solves), case_table(cases), kPairing, model);
  found.cases = texts(cases, &ErrorCase::name);
  summarize_cases(found, policy);
  return found;
}

void summarize_cases(Evaluation& found, NotConverged policy) {
  const EvaluationResult& all = found.solves;
  found.mean = decltype(found.mean)({all.responses(), found.cases.size()}, kNaN);
  found.extreme = found.mean;
  found.count = decltype(found.count)(found.mean.lengths());
  for (std::size_t r = 0; r < all.responses(); ++r) {
    for (std::size_t c = 0; c < found.cases.size(); ++c) {
      std::uint64_t count = 0;
      double sum = 0.0;
      double extreme = 0.0;
      for (std::size_t m = 0; m < all.poses(); ++m) {
        if (!counts(all.status(m, c), policy)) continue;
        const double value = all.response(r, m, c);
        sum += value;
        if (std::abs(value) > std::abs(extreme)) extreme = value;
        ++count;
      }
      found.count(r, c) = count;
      if (count == 0) continue;
      found.mean(r, c) = sum / static_cast<double>(count);
      found.extreme(r, c) = extreme;
    }
  }
}

std::vector<RowOutcome> row_outcomes(const Evaluation& found, std::size_t response) {
  const EvaluationResult& solves = found.solves;
  std::vector<RowOutcome> rows(found.labels.names.size());
  for (std::size_t m = 0; m < solves.poses(); ++m) {
    for (std::size_t s = 0; s < solves.samples(); ++s) {
      if (!solved(solves.status(m, s))) continue;
      const double value = solves.response(response, m, s);
      RowOutcome& row = rows[row_of_solve(found, m, s)];
      if (row.solved == 0) row.mean = row.extreme = 0.0;
      row.mean += value;  // the sum, until it is divided below
      if (row.solved == 0 || std::abs(value) > std::abs(row.extreme)) {
        row.extreme = value;
        row.pose = m;
      }
      ++row.solved;
    }
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

std::string no_column_text(const Evaluation& found) {
  constexpr std::size_t kMostNamed = 5;
  const std::size_t zero = found.zero_errors.size();
  if (zero == 0) return {};
  return fmt::format("{} of {} errors have no column and are zero ({})", zero,
                     zero + found.errors.length<axis::Factor>(), some_names(found.zero_errors, kMostNamed));
}

std::string zero_errors_text(const Evaluation& found) {
  if (found.zero_errors.empty()) return {};
  return no_column_text(found) + "; errors.machines in a Monte Carlo study draws them";
}

constinit const Kind kKind{.study = kStudy,
                           .run = {run_study_of_kind, cases_outlook, shards_by_pose},
                           .file = kFile,
                           .report = kReport,
                           .given_errors = evaluated_errors};

}  // namespace poesy::evaluate
