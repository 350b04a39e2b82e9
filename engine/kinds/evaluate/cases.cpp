#include "engine/kinds/evaluate/cases.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/run/evaluation.h"
#include "engine/run/result.h"

namespace poesy {

ErrorTable case_table(std::span<const ErrorCase> cases) {
  ErrorTable table;
  table.rows = cases.size();
  if (cases.empty()) return table;
  for (std::size_t f = 0; f < cases.front().errors.size(); ++f) table.factors.emplace_back(f);
  for (const ErrorCase& one : cases) table.values.insert(table.values.end(), one.errors.begin(), one.errors.end());
  return table;
}

CaseResult case_result(EvaluationResult evaluation, NotConverged policy) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  CaseResult result;
  const std::size_t cases = evaluation.samples;
  const std::size_t all = evaluation.poses * cases;
  for (std::size_t r = 0; r < evaluation.responses; ++r) {
    for (std::size_t c = 0; c < cases; ++c) {
      std::uint64_t count = 0;
      double sum = 0.0;
      double largest = -std::numeric_limits<double>::infinity();
      for (std::size_t m = 0; m < evaluation.poses; ++m) {
        if (!counts(evaluation.status[m * cases + c], policy)) continue;
        const double value = evaluation.response[r * all + m * cases + c];
        sum += value;
        largest = std::max(largest, value);
        ++count;
      }
      result.count.push_back(count);
      result.mean.push_back(count == 0 ? kNone : sum / static_cast<double>(count));
      result.max.push_back(count == 0 ? kNone : largest);
    }
  }
  result.evaluation = std::move(evaluation);
  return result;
}

}  // namespace poesy
