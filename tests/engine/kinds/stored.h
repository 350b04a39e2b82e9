#pragma once

#include <string>
#include <vector>

#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/sensitivity/result.h"

/// What a kind found, of results that tests make or change.
namespace poesy {

/// Made where the result has nothing yet.
template <class Found>
Found& found_in(StoredResult& result) {
  if (!result.found.has_value()) result.found.emplace<Found>();
  return std::any_cast<Found&>(result.found);
}

inline StoredSensitivity& sensitivity_in(StoredResult& result) { return found_in<StoredSensitivity>(result); }
inline MonteCarloResult& monte_carlo_in(StoredResult& result) { return found_in<MonteCarloResult>(result); }
inline StoredCoupling& coupling_in(StoredResult& result) { return found_in<StoredCoupling>(result); }

/// The tables that the result's kind has, its errors ranked by this response.
inline std::vector<Table> result_tables(const StoredResult& result, const std::string& ranked_by,
                                        RowOrder order = RowOrder::effect) {
  return result_tables(kind_of(result).report, result, {ranked_by, order});
}

/// How its solves ended.
inline SolveTally tally_of(const StoredResult& result) { return kind_of(result).report.tally(result); }

}  // namespace poesy
