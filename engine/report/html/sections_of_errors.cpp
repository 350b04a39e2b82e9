#include <fmt/format.h>

#include <cmath>

#include "engine/report/display.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/sections.h"
#include "engine/report/tables.h"
#include "engine/run/result.h"

namespace poesy {
namespace {

Bars bars_of_shares(const StoredResult& result, std::vector<BarQuantity> quantities) {
  return {{}, std::move(quantities), names_of(result.factors)};
}

BarQuantity share(std::string label, const std::string& array, const std::vector<double>& values, ArrayPool& pool) {
  return {std::move(label), {{"%"}}, pool.add(array, values, 0.01)};
}

/// The largest magnitude over the responses of a measure [R x P] of each error; NaN where none is known.
std::vector<double> largest(const std::vector<double>& measure, std::size_t factors) {
  std::vector<double> list(factors, std::nan(""));
  for (std::size_t at = 0; at < measure.size(); ++at) {
    list[at % factors] = std::fmax(list[at % factors], std::abs(measure[at]));
  }
  return list;
}

}  // namespace

void add_separation(const StoredResult& result, std::vector<Table>& tables, Page& page) {
  if (!result.sensitivity.separation) return;
  const SeparationResult& found = *result.sensitivity.separation;
  Section section("calibration", "What calibration can remove");
  section.paragraph(fmt::format(
      "To first order, a part of each error's effect enters through the actuated directions, where a correction of the "
      "actuators can take it away. The removable share is what the best correction at each pose removes; what is left "
      "has to be prevented by tolerances. The effect is measured by {}. Of all errors together, {} is removable.",
      result.separation_measure, percent_text(found.removable_together)));
  ArrayPool& pool = page.figures.pool;
  add_figure(
      page, section, "separation",
      bars_of_shares(result, {share("removable by calibration", "removable", found.removable, pool),
                              share("enters through the actuated directions", "drive_share", found.drive_share, pool)}),
      "How much of each error's effect calibration can remove.");
  for (const Table& table : take_tables(tables, std::vector<std::string_view>{"separation"})) section.table(table);
  page.sections.push_back(std::move(section));
}

void add_fidelity(const StoredResult& result, std::vector<Table>& tables, Page& page) {
  if (!result.sensitivity.fidelity) return;
  const FidelityResult& found = *result.sensitivity.fidelity;
  Section section("linearity", "Is first order enough");
  section.paragraph(
      fmt::format("The study was solved at fidelity \"{}\" and, on the same draws, at \"{}\". An error is linear where "
                  "they differ by no more than {:.3g} % of its largest effect, at the size the study sets.",
                  result.fidelities[0], result.fidelities[1], 100.0 * found.linearity));
  ArrayPool& pool = page.figures.pool;
  const std::size_t factors = result.factors.size();
  add_figure(
      page, section, "fidelity",
      bars_of_shares(result, {share("nonlinearity: change of mean and scatter", "nonlinearity",
                                    largest(found.nonlinearity, factors), pool),
                              share("discrepancy of the indices", "discrepancy",
                                    largest(found.relative_discrepancy, factors), pool)}),
      "How far the fidelities are apart, the largest of all responses, in percent of the error's largest effect.");
  for (const Table& table : take_tables(tables, std::vector<std::string_view>{"fidelity"})) section.table(table);
  page.sections.push_back(std::move(section));
}

}  // namespace poesy
