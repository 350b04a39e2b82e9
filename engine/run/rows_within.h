#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/run/evaluation.h"

namespace poesy {

/// For each row of errors of an evaluation, 1 if the row is within all limits, otherwise 0. See judge_rows(), which has
/// the same preconditions.
std::vector<std::uint8_t> rows_within(std::span<const ResponseLimit> limits, const EvaluationResult& found,
                                      Pairing pairing, NotConverged policy);

}  // namespace poesy
