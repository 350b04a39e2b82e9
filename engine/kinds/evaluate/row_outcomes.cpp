#include "engine/kinds/evaluate/row_outcomes.h"
#include "engine/run/evaluation.h"

#include <cmath>

namespace poesy {

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

}  // namespace poesy
