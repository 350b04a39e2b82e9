#pragma once

#include <string>
#include <vector>

#include "engine/files/file_kind.h"
#include "engine/files/result_file.h"
#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/kind.h"
#include "engine/model/model.h"
#include "engine/report/report_kind.h"
#include "engine/report/tables.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"

/// What a file keeps of an evaluation: of a study's cases, or of a table of errors.
namespace poesy {

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

/// evaluation_table, or per case mean and maximum of each response over the poses that count; per labelled row of
/// errors, mean and extreme of each response over the poses.
std::vector<Table> evaluation_tables(const StoredResult& result, const TableOptions& options = {});

/// How files keep what such a study found, and how reports show it.
/// @{
extern const FileKind kEvaluationFile;
extern const ReportKind kEvaluationReport;
/// @}

}  // namespace poesy
