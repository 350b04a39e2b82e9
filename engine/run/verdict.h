#pragma once

#include <span>

#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

/// Judges limits by an evaluation, row by row of its errors: a row (a case) is within a limit if its largest magnitude
/// over all its poses is, and every one of them counts (see counts()). A limit is kept if every row is within it.
LimitVerdicts judge_rows(std::span<const ResponseLimit> limits, const EvaluationResult& found, Pairing pairing,
                         NotConverged policy);

}  // namespace poesy
