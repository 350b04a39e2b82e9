#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/base/nan.h"
#include "engine/kinds/kind.h"
#include "engine/model/model.h"
#include "engine/report/table.h"
#include "engine/result/result_file.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

/// A fixed set of errors with a name.
struct ErrorCase {
  std::string name;            ///< name in tables
  std::vector<double> errors;  ///< [F], SI
};

/// The options of a study of cases.
struct CaseOptions {
  std::vector<ErrorCase> cases;  ///< in the order of the study
};

/// The kind of study of named cases of fixed errors.
extern const StudyKind kEvaluateStudy;

namespace axis {
using Case = Axis<"case">;  ///< Named cases of errors.
using Row = Axis<"row">;    ///< Rows of a table of errors.
}  // namespace axis

/// The responses to given errors: named cases, or the rows of a table. StoredResult has the verdicts on limits.
struct Evaluation {
  /// A number for each response and case, over the poses that count; empty if there are no cases.
  template <class T>
  using OverPoses = Array<T, axis::Response, axis::Case>;

  EvaluationResult solves;          ///< solves, with cases or rows of the table as samples
  std::vector<Detail> details;      ///< details of the model; solves.detail has their components one after the other
  std::vector<std::string> joints;  ///< names of the joints
  Pairing pairing = Pairing::every_pose_with_every_row;  ///< how poses and rows of errors are paired
  Array<double, axis::Row, axis::Factor> errors;         ///< errors that were given, SI
  RowLabels labels;                                      ///< labels of the rows of errors; empty if they have none
  std::vector<std::string> cases;                        ///< names of the cases; empty for rows of a table
  OverPoses<double> mean;                                ///< mean response; NaN if no pose counts
  OverPoses<double> max;                                 ///< largest response; NaN if no pose counts
  OverPoses<std::uint64_t> count;                        ///< number of poses that count
};

/// The errors of named cases as a table: a row for each case, a column for each of the model's factors.
ErrorTable case_table(std::span<const ErrorCase> cases);

/// The evaluation of rows of errors from what run_evaluation() found.
Evaluation evaluation(EvaluationResult solves, const ErrorTable& errors, Pairing pairing,
                      const ModelDescription& model);

/// The evaluation of the rows of case_table(), with sums over the poses whose solves count (see counts()).
Evaluation evaluation_of_cases(EvaluationResult solves, std::span<const ErrorCase> cases, const ModelDescription& model,
                               NotConverged policy);

/// The evaluation in a stored result. Precondition: the result is an evaluation.
inline const Evaluation& evaluation_of(const StoredResult& result) { return found_of<Evaluation>(result); }

/// The errors of the solves of an evaluation.
GivenErrors evaluated_errors(const StoredResult& result);

/// Names of the rows of errors for a limit: "part 17" for rows with labels, "sample 3" if each pose was solved with all
/// rows.
std::vector<std::string> row_names(const RowLabels& labels, Pairing pairing, std::size_t rows);

/// Writes the result of `poesy evaluate`, whose poses and errors come from tables; see write_result(). factors: the
/// errors that the table gives.
void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses,
                      std::span<const FactorIndex> factors, const Evaluation& found, const RunFacts& facts);

/// The mean and the extremes of each response over all solved samples. If the rows of errors have labels, notes name
/// the worst row.
Table evaluation_table(const StoredResult& result);

/// The response to one row of errors over the poses where it was solved; NaN if it was solved at none.
struct RowOutcome {
  std::size_t solved = 0;  ///< number of solved poses
  double mean = kNaN;      ///< SI
  double extreme = kNaN;   ///< the value of the largest magnitude, SI
  std::size_t pose = 0;    ///< the first pose of that value
};

/// The outcome of each row, in their order. Precondition: the rows of the evaluation have labels.
std::vector<RowOutcome> row_outcomes(const Evaluation& found, std::size_t response);

/// The position of the row whose extreme has the largest magnitude, the first of equals; the number of rows if none was
/// solved.
std::size_t worst_row(const std::vector<RowOutcome>& outcomes);

/// The row of errors of a solve.
inline std::size_t row_of_solve(const Evaluation& found, std::size_t pose, std::size_t sample) {
  return found.pairing == Pairing::row_by_row ? pose : sample;
}

}  // namespace poesy
