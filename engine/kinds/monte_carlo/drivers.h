#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/kinds/monte_carlo/result.h"
#include "engine/report/html/parts.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"

/// How tables and reports show on which errors a yield depends.
namespace poesy {

/// These positions by a value of each, the largest first; NaN last.
std::vector<std::size_t> largest_first(std::vector<std::size_t> order, const std::function<double(std::size_t)>& value);

/// Values of each error, response by response in this order.
std::vector<double> in_order(const MainEffects::Indices& values, std::span<const std::size_t> responses);

/// The shares of the mean square of a limited response.
struct ResponseShares {
  std::size_t response;          ///< the limited one that rejects most machines, of those whose shares are known
  std::span<const double> each;  ///< of the errors, in the result; NaN for correlated ones
};

/// None where the result has no yield, or no shares of it are known.
std::optional<ResponseShares> response_shares(const StoredResult& result);

/// Shares of the mean squares of the limited responses, then what the yield changes by with each error. Empty without a
/// yield.
std::vector<Table> driver_tables(const StoredResult& result);

/// The section of a report with both, in figures and tables. Precondition: the result has a yield.
void add_drivers_section(const StoredResult& result, std::span<const Table> tables, Page& page);

}  // namespace poesy
