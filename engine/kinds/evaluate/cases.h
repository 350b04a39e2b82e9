#pragma once

#include <cstddef>
#include <cstdint>
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

namespace poesy::axis {

using Case = Axis<"case">;  ///< Named cases of errors.
using Row = Axis<"row">;    ///< Rows of a table of errors.

}  // namespace poesy::axis

namespace poesy::evaluate {

/// A named set of fixed errors.
struct ErrorCase {
  std::string name;            ///< name in tables
  std::vector<double> errors;  ///< [all errors] values of all errors, SI
};

/// The options of a study of kind `evaluate`.
struct CaseOptions {
  std::vector<ErrorCase> cases;  ///< the cases, in the order of the study
};

/// The kind of study `evaluate`, which solves named cases of fixed errors.
extern const StudyKind kStudy;

/// The responses to errors that are stated and not drawn: named cases, or rows of a table. The verdicts on limits are
/// in StoredResult.
struct Evaluation {
  /// A number for each response and case, computed over the poses whose solves count in statistics (see counts()).
  /// Empty if the errors are rows of a table.
  template <class T>
  using OverPoses = Array<T, axis::Response, axis::Case>;

  EvaluationResult solves;  ///< outcomes of solves; a sample is a case, or a row of the table of errors
  /// Descriptions of the model's additional outputs. `solves.detail` has their components, one after another.
  std::vector<Detail> details;
  std::vector<std::string> joints;                       ///< names of the joints whose displacements are in `solves`
  Pairing pairing = Pairing::every_pose_with_every_row;  ///< how poses and rows of errors are paired
  /// [rows x errors with a column] Errors of each row, SI; for named cases, all errors of the model have a column.
  Array<double, axis::Row, axis::Factor> errors;
  RowLabels labels;                      ///< labels of the rows; empty if the rows have none
  std::vector<std::string> zero_errors;  ///< names of the errors that have no column in the table and are zero
  /// [rows] 1: the row is within all limits; 0: it is not. Empty if the study states no limits.
  std::vector<std::uint8_t> within_limits;
  std::vector<std::string> cases;  ///< names of the cases; empty if the errors are rows of a table
  /// Mean of a response over the poses whose solves count in statistics (counts()); NaN if there are none.
  OverPoses<double> mean;
  /// Value of a response with the largest magnitude over the poses of `mean`; NaN if there are none.
  OverPoses<double> extreme;
  OverPoses<std::uint64_t> count;  ///< number of the poses of `mean`
};

/// The errors of named cases as a table: a row for each case, a column for each of the model's factors.
ErrorTable case_table(std::span<const ErrorCase> cases);

/// Makes an evaluation from the outcomes of run_evaluation() and the table of errors that was solved.
Evaluation evaluation(EvaluationResult solves, const ErrorTable& errors, Pairing pairing,
                      const ModelDescription& model);

/// Makes an evaluation from the outcomes for the rows of case_table(), and computes summaries over the poses whose
/// solves count (see counts()).
Evaluation evaluation_of_cases(EvaluationResult solves, std::span<const ErrorCase> cases, const ModelDescription& model,
                               NotConverged policy);

/// Sets `mean`, `extreme` and `count` of each case. policy: which solves count, see counts().
void summarize_cases(Evaluation& found, NotConverged policy);

/// The evaluation in a stored result. Precondition: the result is of kind `evaluate`.
inline const Evaluation& evaluation_of(const StoredResult& result) { return found_of<Evaluation>(result); }

/// The errors of an evaluation, for `poesy replay`; see Kind::given_errors.
GivenErrors evaluated_errors(const StoredResult& result);

/// The line number (from 1) of a row of errors in the file of the table. The first line has the names of the columns.
inline std::size_t line_of_row(std::size_t row) { return row + 2; }

/// Names of the rows of errors, for verdicts: "part 17" if the rows have labels, otherwise "line 5 (sample 3)", with
/// samples counted from 0. Empty if rows have no labels and each row has its own pose.
std::vector<std::string> row_names(const RowLabels& labels, Pairing pairing, std::size_t rows);

/// A clause like "56 of 68 errors have no column and are zero (play_1, play_2 and 54 more)". Empty if each error has a
/// column, or if the errors are those of named cases.
std::string no_column_text(const Evaluation& found);

/// The clause of no_column_text(), followed by the key with which a Monte Carlo study draws these errors. Empty if
/// no_column_text() is empty.
std::string zero_errors_text(const Evaluation& found);

/// Writes the result of `poesy evaluate`, whose poses and errors come from tables; see write_result(). factors: the
/// errors in the columns of the table.
void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses,
                      std::span<const FactorIndex> factors, const Evaluation& found, const RunFacts& facts);

/// A table with the mean, the smallest and the largest value of each headline response over all solved samples. If the
/// rows of errors have labels, notes name the worst row for each response.
Table evaluation_table(const StoredResult& result);

/// A response to one row of errors, summarised over the poses at which the row was solved. `mean` and `extreme` are NaN
/// if there are no such poses.
struct RowOutcome {
  std::size_t solved = 0;  ///< number of solved poses
  double mean = kNaN;      ///< mean over the solved poses, SI
  double extreme = kNaN;   ///< value with the largest magnitude over the solved poses, SI
  std::size_t pose = 0;    ///< index of the first pose with the value `extreme`
};

/// The outcome of each row of errors, in order. Precondition: the rows of the evaluation have labels.
std::vector<RowOutcome> row_outcomes(const Evaluation& found, std::size_t response);

/// The position of the row whose `extreme` has the largest magnitude, the first of equal ones. The number of rows if no
/// row was solved.
std::size_t worst_row(const std::vector<RowOutcome>& outcomes);

/// The row of errors that was used in the solve of this sample at this pose.
inline std::size_t row_of_solve(const Evaluation& found, std::size_t pose, std::size_t sample) {
  return found.pairing == Pairing::row_by_row ? pose : sample;
}

}  // namespace poesy::evaluate
