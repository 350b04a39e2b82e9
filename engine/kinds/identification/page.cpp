#include <fmt/format.h>

#include "engine/kinds/identification/identification.h"
#include "engine/kinds/identification/stored.h"
#include "engine/kinds/registry.h"
#include "engine/report/display.h"

namespace poesy {
namespace {

std::vector<std::string> group_names(const StoredResult& result) {
  std::vector<std::string> names;
  for (const ErrorSize& group : identification_of(result).sizes) names.push_back(group.name);
  return names;
}

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
  const IdentificationResult& found = identification_of(result);
  const Choice sizes{"size of the errors", group_names(result)};
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

void add_page(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const IdentificationResult& found = identification_of(result);
  Section& section = page.add_section("which-errors-deform", "Which errors deform the mechanism");
  section.paragraph(fmt::format(
      "Each error was set alone, and then together with those of its frame that do not deform alone, at {}. An error "
      "is harmless where nothing deforms by more than {:.3g}, which is rounding, at {} of the {} poses; a pose that "
      "was "
      "not solved counts as deformed.",
      counted(found.groups, "size", "sizes"), found.rounding, count_text(found.required_poses),
      count_text(found.poses)));
  add_figure(page, section, "deforming", bars_of(result, page.figures.pool),
             "At how many of the poses each error deforms the mechanism.");
  for (const Table& table : tables) section.table(table);
}

SolveTally tally(const StoredResult& result) { return {"", {"all errors"}, 1, {identification_of(result).solves}}; }

StudyWords words(const StoredResult& result) { return {.sizes = group_names(result)}; }

ShownCells cells(const StoredResult& result) { return shown_cells(result, kSummaryRows); }

Comparable comparable(const StoredResult& result, const StoredResult&) {
  const IdentificationResult& found = identification_of(result);
  std::vector<double> percent;
  for (const std::uint64_t below : found.single_below) {
    percent.push_back(100.0 - 100.0 * static_cast<double>(below) / static_cast<double>(found.poses));
  }
  return {.option_word = "size of the errors",
          .options = group_names(result),
          .item_word = "error",
          .items = names_of(result.factors),
          .quantities = {{"poses where the error deforms alone", "deforms",
                          std::vector<std::vector<std::string>>(found.groups, {"%"}), std::move(percent)}}};
}

}  // namespace

constinit const ReportKind kIdentificationReport{.tally = tally,
                                                 .tables = identification_tables,
                                                 .words = words,
                                                 .shown_cells = cells,
                                                 .page = add_page,
                                                 .comparable = comparable};

}  // namespace poesy
