#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/monte_carlo/result.h"
#include "engine/report/html/parts.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"

/// Tables and report section of the errors on which a yield depends.
namespace poesy::monte_carlo {

/// Sorts the positions in `order` by decreasing value(position); positions with NaN come last.
std::vector<std::size_t> largest_first(std::vector<std::size_t> order, const std::function<double(std::size_t)>& value);

/// The values of all errors, one response after the other in the order of `responses`.
std::vector<double> in_order(const MainEffects::Indices& values, std::span<const std::size_t> responses);

/// The shares of errors in the scatter of a limited response.
struct ResponseShares {
  std::size_t response;          ///< position of the limited response
  std::span<const double> each;  ///< [errors] share of each error; NaN for correlated errors; refers to the result
  std::vector<std::size_t> correlated;  ///< positions of the errors whose shares are known only together
  double together;  ///< joint share of the correlated errors: the share that is linear in the errors, minus the shares
                    ///< of the other errors; 0 without correlated errors
};

/// Name of correlated errors as one source of scatter: "6 correlated errors together".
std::string together_text(const ResponseShares& shares);

/// The shares of errors in the scatter of the limited response that rejects most machines, among the responses with
/// known shares; none if the result has no yield or no known shares.
std::optional<ResponseShares> response_shares(const StoredResult& result);

/// Tables of the errors' shares in the scatter of the limited responses, and of the change of the yield by each
/// error. Empty if the result has no yield.
std::vector<Table> driver_tables(const StoredResult& result);

/// Adds to the page the section of errors on which the yield depends, with figures and these tables. Precondition: the
/// result has a yield.
void add_drivers_section(const StoredResult& result, std::span<const Table> tables, Page& page);

}  // namespace poesy::monte_carlo
