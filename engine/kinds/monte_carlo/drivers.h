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

/// Tables and report of the errors on which a yield depends.
namespace poesy {

/// Orders positions by their values, the largest first and NaN last.
std::vector<std::size_t> largest_first(std::vector<std::size_t> order, const std::function<double(std::size_t)>& value);

/// The values of each error, response by response in this order.
std::vector<double> in_order(const MainEffects::Indices& values, std::span<const std::size_t> responses);

/// The shares of the mean square of a limited response.
struct ResponseShares {
  std::size_t response;  ///< among the limited responses whose shares are known, the one that rejects most machines
  std::span<const double> each;  ///< [P] shares of the errors, a view into the result; NaN for correlated errors
};

/// The shares; none if the result has no yield or no known shares.
std::optional<ResponseShares> response_shares(const StoredResult& result);

/// Tables of the shares in the mean squares of the limited responses, then of the change of the yield by each error.
/// Empty without a yield.
std::vector<Table> driver_tables(const StoredResult& result);

/// Adds the section of a report with both, as figures and tables. Precondition: the result has a yield.
void add_drivers_section(const StoredResult& result, std::span<const Table> tables, Page& page);

}  // namespace poesy
