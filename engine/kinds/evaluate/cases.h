#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/kinds/evaluate/options.h"
#include "engine/run/result.h"
#include "engine/run/runner.h"

namespace poesy {

/// The errors of named cases as a table: a row for each case, a column for each of the model's factors.
ErrorTable case_table(std::span<const ErrorCase> cases);

/// What run_evaluation found for a case_table, summed up over the poses whose solve counts (see counts()).
CaseResult case_result(EvaluationResult evaluation, NotConverged policy);

}  // namespace poesy
