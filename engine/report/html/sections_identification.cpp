#include <fmt/format.h>

#include "engine/report/display.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/sections.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

/// Of counts of poses [G x P], the share of all poses, or of all but these.
std::vector<double> share_of_poses(const IdentificationResult& found, const std::vector<std::uint64_t>& counts,
                                   bool but_these) {
  std::vector<double> list;
  for (const std::uint64_t count : counts) {
    const std::uint64_t those = but_these ? found.poses - count : count;
    list.push_back(static_cast<double>(those) / static_cast<double>(found.poses));
  }
  return list;
}

Bars bars_of(const StoredResult& result, ArrayPool& pool) {
  const IdentificationResult& found = result.identification;
  Choice sizes{"size of the errors", {}};
  for (const ErrorSize& group : result.groups) sizes.options.push_back(group.name);
  const std::vector<std::vector<std::string>> percent(found.groups, {"%"});
  const auto quantity = [&](std::string label, const std::string& array, const std::vector<double>& shares) {
    return BarQuantity{std::move(label), percent, pool.add(array, shares, 0.01)};
  };
  return {{sizes},
          {quantity("poses where the error deforms alone", "single", share_of_poses(found, found.single_below, true)),
           quantity("poses where the errors of its frame deform together", "coupled",
                    share_of_poses(found, found.coupled_below, true)),
           quantity("poses where leaving it out of them takes nine tenths away", "coupled_reduced",
                    share_of_poses(found, found.coupled_reduced, false))},
          names_of(result.factors)};
}

}  // namespace

void add_identification(const StoredResult& result, Page& page) {
  const IdentificationResult& found = result.identification;
  Section section("which-errors-deform", "Which errors deform the mechanism");
  section.paragraph(fmt::format(
      "Each error was set alone, and then together with those of its frame that do not deform alone, at {}. An error "
      "is harmless where nothing deforms by more than {:.3g}, which is rounding, at {} of the {} poses; a pose that "
      "was "
      "not solved counts as deformed.",
      counted(found.groups, "size", "sizes"), found.rounding, count_text(found.required_poses),
      count_text(found.poses)));
  add_figure(page, section, "deforming", bars_of(result, page.figures.pool),
             "At how many of the poses each error deforms the mechanism.");
  for (const Table& table : result_tables(result, default_ranking(result))) section.table(table);
  page.sections.push_back(std::move(section));
}

}  // namespace poesy
