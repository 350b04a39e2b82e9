#include <fmt/format.h>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {

std::optional<Table> separation_table(const StoredResult& result, const RankedErrors& ranked) {
  if (!result.sensitivity.separation) return std::nullopt;
  const SeparationResult& found = *result.sensitivity.separation;
  Table table{
      .name = "separation",
      .caption = "What calibration can remove of each error's effect, to first order, over the poses",
      .columns = {number_column("rank", "rank", "", 2), text_column("error", "error"),
                  text_column("published_class", "published class", 1), percent_column("drive_share", "drive share"),
                  percent_column("removable", "removable by calibration")},
      .rows = {},
      .notes = {"effect: " + result.separation_measure,
                fmt::format("all errors together, at the size the study sets: {} of the effect is removable",
                            percent_text(found.removable_together))},
      .ranked = true};
  for (const std::size_t p : ranked.rows) {
    table.rows.push_back({count_cell(ranked.ranks[p]), text_cell(result.factors[p].name),
                          text_cell(result.published_class[p]), percent_cell(found.drive_share[p]),
                          percent_cell(found.removable[p])});
  }
  return table;
}

}  // namespace poesy
