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

namespace poesy {

/// A fixed set of errors with a name.
struct ErrorCase {
  std::string name;            ///< name in tables
  std::vector<double> errors;  ///< [all errors] values of all errors, SI
};

/// The options of a study of kind `evaluate`.
struct CaseOptions {
  std::vector<ErrorCase> cases;  ///< the cases, in the order of the study
};

/// The kind of study that solves named cases of fixed errors, `evaluate`.
extern const StudyKind kEvaluateStudy;

namespace axis {
using Case = Axis<"case">;  ///< Named cases of errors.
using Row = Axis<"row">;    ///< Rows of a table of errors.
}  // namespace axis

/// The responses to given errors: named cases, or rows of a table. The verdicts on limits are in StoredResult.
struct Evaluation {
  /// A number for each response and case, computed over the poses whose solves count in statistics (see counts()).
  /// Empty if the errors are rows of a table.
  template <class T>
  using OverPoses = Array<T, axis::Response, axis::Case>;

  EvaluationResult solves;  ///< outcomes of solves; a sample is a case, or a row of the error table
  /// The model's additional outputs; their components are in `solves.detail`, one after another.
  std::vector<Detail> details;
  std::vector<std::string> joints;                       ///< names of the joints whose displacements are in `solves`
  Pairing pairing = Pairing::every_pose_with_every_row;  ///< how poses and rows of errors are paired
  Array<double, axis::Row, axis::Factor> errors;         ///< [rows x all errors] errors that were given, SI
  RowLabels labels;                                      ///< labels of the rows; empty if the rows have none
  std::vector<std::string> zero_errors;  ///< names of the errors without a column in the table; they are zero
  /// [rows] 1: the row is within all limits; 0: it is not. Empty if the study states no limits.
  std::vector<std::uint8_t> within_limits;
  std::vector<std::string> cases;  ///< names of the cases; empty if the errors are rows of a
                                   ///< table
  OverPoses<double> mean;          ///< mean of a response over the poses whose solves count; NaN if there are none
  /// Value of a response with the largest magnitude over the poses whose solves count; NaN if there are none.
  OverPoses<double> extreme;
  OverPoses<std::uint64_t> count;  ///< number of poses whose solves count
};

/// The errors of named cases as a table: a row for each case, a column for each of the model's factors.
ErrorTable case_table(std::span<const ErrorCase> cases);

/// Makes an evaluation from the outcomes of run_evaluation() and the rows of errors that were solved.
Evaluation evaluation(EvaluationResult solves, const ErrorTable& errors, Pairing pairing,
                      const ModelDescription& model);

/// Makes an evaluation from the outcomes for the rows of case_table(), and computes summaries over the poses whose
/// solves count (see counts()).
Evaluation evaluation_of_cases(EvaluationResult solves, std::span<const ErrorCase> cases, const ModelDescription& model,
                               NotConverged policy);

/// Sets mean, extreme and count of each case from its solves.
void summarize_cases(Evaluation& found, NotConverged policy);

/// The evaluation in a stored result. Precondition: the result is of kind `evaluate`.
inline const Evaluation& evaluation_of(const StoredResult& result) { return found_of<Evaluation>(result); }

/// The given errors of an evaluation, for `poesy replay`; see Kind::given_errors.
GivenErrors evaluated_errors(const StoredResult& result);

/// The line of a row of errors in its table: the first line has the names of the columns.
inline std::size_t line_of_row(std::size_t row) { return row + 2; }

/// Names of the rows of errors, for verdicts: "part 17" if the rows have labels, otherwise "line 5 (sample 3)" if each
/// pose was solved with all rows; samples are counted from 0. Empty if each row has its own pose and no label.
std::vector<std::string> row_names(const RowLabels& labels, Pairing pairing, std::size_t rows);

/// "56 of 68 errors have no column and are zero (play_1, play_2 and 54 more)". Empty if each error has a column, or if
/// the errors are those of cases.
std::string no_column_text(const Evaluation& found);

/// "56 of 68 errors have no column and are zero (play_1, play_2 and 54 more); ...", with what draws them. Empty if each
/// error has a column, or if the errors are those of cases.
std::string zero_errors_text(const Evaluation& found);

/// Writes the result of `poesy evaluate`, whose poses and errors come from tables; see write_result(). factors: the
/// errors in the columns of the table.
void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses,
                      std::span<const FactorIndex> factors, const Evaluation& found, const RunFacts& facts);

/// A table with the mean and the extremes of each response over all solved samples. If the rows of errors have labels,
/// a note names the worst row.
Table evaluation_table(const StoredResult& result);

/// A response to one row of errors, over the poses at which it was solved. `mean` and `extreme` are NaN if no pose was
/// solved.
struct RowOutcome {
  std::size_t solved = 0;  ///< number of solved poses
  double mean = kNaN;      ///< mean over the solved poses, SI
  double extreme = kNaN;   ///< value with the largest magnitude, SI
  std::size_t pose = 0;    ///< first pose with that value
};

/// The outcome of each row of errors, in order. Precondition: the rows of the evaluation have labels.
std::vector<RowOutcome> row_outcomes(const Evaluation& found, std::size_t response);

/// The position of the row whose `extreme` has the largest magnitude, the first of equal ones. The number of rows if no
/// row was solved.
std::size_t worst_row(const std::vector<RowOutcome>& outcomes);

/// The row of errors that a solve used.
inline std::size_t row_of_solve(const Evaluation& found, std::size_t pose, std::size_t sample) {
  return found.pairing == Pairing::row_by_row ? pose : sample;
}

}  // namespace poesy
