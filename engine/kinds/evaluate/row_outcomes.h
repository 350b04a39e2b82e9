#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "engine/files/result_file.h"
#include "engine/kinds/evaluate/stored.h"
#include "engine/run/evaluation.h"

namespace poesy {

/// What one row of errors does to a response, over the poses where it was solved. Without any, NaN.
struct RowOutcome {
  std::size_t solved = 0;                                     ///< poses
  double mean = std::numeric_limits<double>::quiet_NaN();     ///< SI
  double extreme = std::numeric_limits<double>::quiet_NaN();  ///< the value of the largest magnitude, SI
  std::size_t pose = 0;                                       ///< the first pose that has it
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
