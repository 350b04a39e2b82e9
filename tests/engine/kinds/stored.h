#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/sensitivity/result.h"

/// Access to the findings (the result of a kind of study) in a StoredResult that a test makes or changes.
namespace poesy {

/// The findings of the result. Creates empty findings if the result has none.
template <class Found>
Found& found_in(StoredResult& result) {
  if (!result.found.has_value()) result.found.emplace<Found>();
  return std::any_cast<Found&>(result.found);
}

inline sensitivity::Result& sensitivity_in(StoredResult& result) { return found_in<sensitivity::Result>(result); }
inline monte_carlo::Result& monte_carlo_in(StoredResult& result) { return found_in<monte_carlo::Result>(result); }
inline coupling::Result& coupling_in(StoredResult& result) { return found_in<coupling::Result>(result); }

/// Sets the global indices [responses x errors] of a sensitivity result, with intervals of zero width and no change at
/// a tenth of the sizes. If the result has no counts of solves, it gets one pose without solves. Precondition: the
/// result has its errors and responses.
inline void set_indices(StoredResult& result, const std::vector<double>& indices) {
  sensitivity::Result& found = sensitivity_in(result);
  const std::array lengths{result.responses.size(), result.factors.size()};
  for (auto* values : {&found.global, &found.global_ci_low, &found.global_ci_high, &found.global_corrected,
                       &found.global_corrected_ci_low, &found.global_corrected_ci_high}) {
    *values = {lengths, indices};
  }
  found.rounding = Array<double, axis::Response>({lengths[0]});
  found.index_change = sensitivity::Result::Indices(lengths);
  if (found.solves.all().empty()) found.solves = Array<SolveCounts, axis::Factor, axis::Pose>({lengths[1], 1});
}

/// The tables of a result. ranked_by: the response that ranks the errors.
inline std::vector<Table> result_tables(const StoredResult& result, const std::string& ranked_by,
                                        RowOrder order = RowOrder::effect) {
  return result_tables(kind_of(result).report, result, {ranked_by, order});
}

/// Counts of how the solves of a result ended.
inline SolveTally tally_of(const StoredResult& result) { return kind_of(result).report.tally(result); }

}  // namespace poesy
