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
  std::string name;            ///< stands in tables
  std::vector<double> errors;  ///< [F], SI
};

/// What a study of cases alone asks.
struct CaseOptions {
  std::vector<ErrorCase> cases;  ///< in the order of the study
};

/// The kind of study of named cases of fixed errors.
extern const StudyKind kEvaluateStudy;

/// What named cases of errors do: C cases, R responses. evaluation has the cases as its samples.
struct CaseResult {
  EvaluationResult evaluation;       ///< with the cases as its samples
  std::vector<double> mean;          ///< [R x C] over the poses that count; NaN where there is none
  std::vector<double> max;           ///< [R x C]
  std::vector<std::uint64_t> count;  ///< [R x C] poses that count
};

/// The errors of named cases as a table: a row for each case, a column for each of the model's factors.
ErrorTable case_table(std::span<const ErrorCase> cases);

/// What run_evaluation found for a case_table, summed up over the poses whose solve counts (see counts()).
CaseResult case_result(EvaluationResult evaluation, NotConverged policy);

/// What an evaluation says, read back. Its verdicts are those of StoredResult. Where the model has details,
/// evaluation.detail holds their components in the order of `details`. `mean`, `max` and `count` are of cases.
struct StoredEvaluation : CaseResult {
  std::vector<Detail> details;                           ///< of the model
  std::vector<std::string> joints;                       ///< [joints] names
  Pairing pairing = Pairing::every_pose_with_every_row;  ///< of poses with rows of errors
  std::vector<double> errors;                            ///< [S x P], or [M x P] row by row; SI
  RowLabels labels;                                      ///< of the rows of errors; empty where they have no names
  std::vector<std::string> cases;                        ///< names of the samples, where they are cases
};

/// Precondition: a result of an evaluation.
inline const StoredEvaluation& evaluation_of(const StoredResult& result) { return found_of<StoredEvaluation>(result); }

/// The errors of its solves.
GivenErrors evaluated_errors(const StoredResult& result);

/// What a limit calls the rows of errors: "part 17" where they have labels, "sample 3" where every pose had all of
/// them.
std::vector<std::string> row_names(const RowLabels& labels, Pairing pairing, std::size_t rows);

/// Writes the result of `poesy evaluate`, which takes poses and errors from tables; as write_result.
void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses, const ErrorTable& errors,
                      Pairing pairing, const EvaluationResult& result, const RunFacts& facts);

/// Per response, the mean and the extremes over all solved samples. Where the rows of errors have labels, notes name
/// the worst.
Table evaluation_table(const StoredResult& result);

/// What one row of errors does to a response, over the poses where it was solved. Without any, NaN.
struct RowOutcome {
  std::size_t solved = 0;  ///< poses
  double mean = kNaN;      ///< SI
  double extreme = kNaN;   ///< the value of the largest magnitude, SI
  std::size_t pose = 0;    ///< the first pose that has it
};

/// Of an evaluation whose rows have labels: the outcome of each, in their order.
std::vector<RowOutcome> row_outcomes(const StoredEvaluation& stored, std::size_t response);

/// The position of the row whose extreme is the largest in magnitude, the first of equals; the number of rows when no
/// row was solved.
std::size_t worst_row(const std::vector<RowOutcome>& outcomes);

/// The row of errors of a solve, `at` counted pose by pose.
inline std::size_t row_of_solve(const StoredEvaluation& stored, std::size_t at) {
  return stored.pairing == Pairing::row_by_row ? at / stored.evaluation.samples : at % stored.evaluation.samples;
}

}  // namespace poesy
