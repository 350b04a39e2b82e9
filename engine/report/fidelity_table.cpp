#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

/// The response where a measure [R x P] of an error has its largest magnitude; none where it has no value.
std::optional<std::size_t> largest(const std::vector<double>& measure, std::size_t factor, std::size_t factors) {
  std::optional<std::size_t> found;
  for (std::size_t r = 0; r * factors < measure.size(); ++r) {
    const double value = std::abs(measure[r * factors + factor]);
    if (!std::isnan(value) && (!found || value > std::abs(measure[*found * factors + factor]))) found = r;
  }
  return found;
}

/// The largest value in percent and its response.
void add_largest(std::vector<Cell>& row, const StoredResult& result, const std::vector<double>& measure,
                 std::size_t factor) {
  const std::size_t factors = result.sensitivity.factors;
  const auto at = largest(measure, factor, factors);
  const double value = at ? measure[*at * factors + factor] : std::numeric_limits<double>::quiet_NaN();
  const bool infinite = std::isinf(value);
  row.push_back(infinite ? text_cell("no effect") : percent_cell(value));
  row.push_back(text_cell(infinite ? "by the first" : at ? result.responses[*at].name : ""));
}

std::string verdict(const FidelityResult& found, std::size_t factor) {
  const std::size_t factors = found.linear.size();
  if (found.linear[factor] == 0) return "not linear";
  return largest(found.nonlinearity, factor, factors) ? "linear" : "no effect";
}

std::vector<std::string> notes(const StoredResult& result, const FidelityResult& found) {
  const auto not_linear = std::ranges::count(found.linear, std::uint8_t{0});
  std::vector<std::string> list{
      fmt::format("{} of {} errors are not linear: they differ by more than {:.3g} %, at the size the study sets",
                  not_linear, found.linear.size(), 100.0 * found.linearity),
      "discrepancy: of the index, in percent of the error's largest; nonlinearity: of mean and spread, in percent of "
      "its largest effect"};
  const auto failed = std::accumulate(found.not_converged.begin(), found.not_converged.end(), std::uint64_t{0});
  if (failed > 0) {
    list.push_back(fmt::format("{} at fidelity \"{}\" did not converge", counted(failed, "solve", "solves"),
                               result.fidelities[1]));
  }
  return list;
}

}  // namespace

std::optional<Table> fidelity_table(const StoredResult& result, const RankedErrors& ranked) {
  if (!result.sensitivity.fidelity) return std::nullopt;
  const FidelityResult& found = *result.sensitivity.fidelity;
  Table table{
      .name = "fidelity",
      .caption =
          fmt::format("Fidelity \"{}\" against \"{}\" on the same draws", result.fidelities[1], result.fidelities[0]),
      .columns = {number_column("rank", "rank", "", 3), text_column("error", "error"),
                  percent_column("discrepancy", "discrepancy"), text_column("discrepancy_response", "largest for", 1),
                  percent_column("nonlinearity", "nonlinearity"),
                  text_column("nonlinearity_response", "largest for", 2), text_column("verdict", "verdict")},
      .rows = {},
      .notes = notes(result, found),
      .ranked = true};
  for (const std::size_t p : ranked.rows) {
    std::vector<Cell> row{count_cell(ranked.ranks[p]), text_cell(result.factors[p].name)};
    add_largest(row, result, found.relative_discrepancy, p);
    add_largest(row, result, found.nonlinearity, p);
    row.push_back(text_cell(verdict(found, p)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace poesy
