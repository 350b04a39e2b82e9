#include <fmt/format.h>

#include "engine/io/tolerance_files.h"
#include "engine/report/display.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/sections.h"
#include "engine/report/index_change.h"
#include "engine/report/tables.h"
#include "engine/report/tolerance_table.h"

namespace poesy {
namespace {

/// Tolerances in the unit shown of each error.
std::vector<double> shown_tolerances(const StoredResult& result, const std::vector<double>& tolerances) {
  std::vector<double> list(tolerances.size());
  for (std::size_t p = 0; p < list.size(); ++p) list[p] = tolerances[p] / display(result.factors[p]).si;
  return list;
}

Bars bars_of(const StoredResult& result, const Tolerances& found, ArrayPool& pool) {
  std::vector<std::string> units;
  for (const NamedUnit& factor : result.factors) units.push_back(unit_text(factor));
  BarQuantity shares{"share of the mean square that the study's sizes cause",
                     {{"%"}},
                     pool.add("mean_square_share", found.mean_square_share, 0.01)};
  BarQuantity sizes{
      "tolerance of equal effect", {units}, pool.add("equal_effect", shown_tolerances(result, found.equal_effect))};
  return {{}, {std::move(shares), std::move(sizes)}, names_of(result.factors)};
}

}  // namespace

void add_tolerances(const StoredResult& result, Page& page) {
  if (!has_tolerances(result)) return;
  Section section("tolerances", "How tight must each be");
  const std::size_t response = response_named(result, default_ranking(result));
  const std::string& name = result.responses[response].name;
  const std::optional<ReferenceError>& reference = result.tolerance_reference[response];
  if (!reference) {
    section.paragraph(fmt::format("No error has an effect on {}, so nothing can be said about tolerances.", name));
    page.sections.push_back(std::move(section));
    return;
  }
  ResponseTolerances found = stored_tolerances(result, response);
  found.caveat = wrong_sizes_text(result, found);
  section.paragraph(fmt::format(
      "Tolerances, as standard deviations of normal errors, with which every error has the same effect on {}: the "
      "tighter one, the more its error matters. They are counted from a reference, and all may be multiplied by one "
      "number. "
      "'poesy tolerances' with --limit gives those that keep {} below a limit, and studies that confirm them.",
      name, name));
  add_figure(page, section, "tolerances", bars_of(result, found.all, page.figures.pool),
             fmt::format(
                 "What each error adds to the mean square of {} over samples and poses, and its tolerance of equal "
                 "effect; {}.",
                 name,
                 mixed_units(result.factors) ? "the largest share first, for tolerances in mm and in deg do not compare"
                                             : "the largest first"));
  section.table(tolerance_table(result, found));
  page.sections.push_back(std::move(section));
}

}  // namespace poesy
