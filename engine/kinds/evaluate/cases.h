#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/kinds/evaluate/options.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

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

}  // namespace poesy
