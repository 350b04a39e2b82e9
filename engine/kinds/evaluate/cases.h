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

namespace axis {
using Case = Axis<"case">;  ///< Named cases of errors.
using Row = Axis<"row">;    ///< Rows of a table of errors.
}  // namespace axis

/// What given errors do: named cases, or the rows of a table. Its verdicts are those of StoredResult.
struct Evaluation {
  /// A number of each response to each case over the poses that count; empty where there are no cases.
  template <class T>
  using OverPoses = Array<T, axis::Response, axis::Case>;

  EvaluationResult solves;          ///< with the cases, or the rows of the table, as samples
  std::vector<Detail> details;      ///< of the model; solves.detail holds their components one after the other
  std::vector<std::string> joints;  ///< names
  Pairing pairing = Pairing::every_pose_with_every_row;  ///< of poses with rows of errors
  Array<double, axis::Row, axis::Factor> errors;         ///< that were given, SI
  RowLabels labels;                                      ///< of the rows of errors; empty where they have no names
  std::vector<std::string> cases;                        ///< names of the samples, where they are cases
  OverPoses<double> mean;                                ///< NaN where no pose counts
  OverPoses<double> max;                                 ///< NaN where no pose counts
  OverPoses<std::uint64_t> count;                        ///< poses that count
};

/// The errors of named cases as a table: a row for each case, a column for each of the model's factors.
ErrorTable case_table(std::span<const ErrorCase> cases);

/// What run_evaluation found for these rows of errors.
Evaluation evaluation(EvaluationResult solves, const ErrorTable& errors, Pairing pairing,
                      const ModelDescription& model);

/// The same for a case_table, summed up over the poses whose solve counts (see counts()).
Evaluation evaluation_of_cases(EvaluationResult solves, std::span<const ErrorCase> cases, const ModelDescription& model,
                               NotConverged policy);

/// Precondition: a result of an evaluation.
inline const Evaluation& evaluation_of(const StoredResult& result) { return found_of<Evaluation>(result); }

/// The errors of its solves.
GivenErrors evaluated_errors(const StoredResult& result);

/// What a limit calls the rows of errors: "part 17" where they have labels, "sample 3" where every pose had all of
/// them.
std::vector<std::string> row_names(const RowLabels& labels, Pairing pairing, std::size_t rows);

/// Writes the result of `poesy evaluate`, which takes poses and errors from tables; as write_result. factors: the
/// errors that the table gives.
void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses,
                      std::span<const FactorIndex> factors, const Evaluation& found, const RunFacts& facts);

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
std::vector<RowOutcome> row_outcomes(const Evaluation& found, std::size_t response);

/// The position of the row whose extreme is the largest in magnitude, the first of equals; the number of rows when no
/// row was solved.
std::size_t worst_row(const std::vector<RowOutcome>& outcomes);

/// The row of errors of this solve.
inline std::size_t row_of_solve(const Evaluation& found, std::size_t pose, std::size_t sample) {
  return found.pairing == Pairing::row_by_row ? pose : sample;
}

}  // namespace poesy
