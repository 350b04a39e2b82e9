#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "engine/kinds/identification/identification.h"
#include "engine/kinds/identification/stored.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

std::string verdict(const IdentificationResult& found, std::size_t p) {
  if (found.single[p] != 0) return "deforms alone";
  return found.coupled[p] != 0 ? "deforms in a coupling" : "absorbed";
}

bool groups_agree(const IdentificationResult& found) {
  for (std::size_t cell = 0; cell < found.coupled_by_group.size(); ++cell) {
    if (found.coupled_by_group[cell] != found.coupled[cell % found.factors]) return false;
    if (found.single_by_group[cell] != found.single[cell % found.factors]) return false;
  }
  return true;
}

std::vector<std::string> notes(const IdentificationResult& found) {
  std::vector<std::string> list{
      fmt::format("under each group of sizes: poses where the error alone deforms, of {}; {} decide, rounding ends at "
                  "{:.3g}",
                  found.poses, found.required_poses, found.rounding)};
  if (!groups_agree(found)) list.push_back("the groups do not agree: see the export's identification.csv");
  return list;
}

Table verdict_table(const StoredResult& result) {
  const IdentificationResult& found = identification_of(result);
  Table table{
      .name = "identification",
      .caption = fmt::format("{} of {} errors deform alone, {} with couplings", std::ranges::count(found.single, 1),
                             found.factors, std::ranges::count(found.coupled, 1)),
      .columns = {},
      .notes = notes(found)};
  std::vector<FilledColumn> columns{
      name_column(result.factors, "error"),
      {text_column("verdict", "verdict"), [&](std::size_t p) { return text_cell(verdict(found, p)); }}};
  for (std::size_t g = 0; g < found.groups; ++g) {
    columns.push_back(
        {number_column(fmt::format("deforming_poses_{}", g + 1), identification_of(result).sizes[g].name, "",
                       static_cast<int>(g)),
         [&, g](std::size_t p) { return count_cell(found.poses - found.single_below[g * found.factors + p]); }});
  }
  fill(table, positions(found.factors), columns);
  return table;
}

Table coupling_rows(const StoredResult& result) {
  Table table{.name = "couplings",
              .caption = "Errors that deform together and not alone",
              .columns = {text_column("error", "error"), text_column("with", "with"), text_column("group", "group"),
                          number_column("deforming_poses", "poses")},
              .notes = {fmt::format("poses: where the two deform, of {}", identification_of(result).poses)}};
  for (const Coupling& coupling : identification_of(result).couplings) {
    table.rows.push_back(
        {text_cell(result.factors[coupling.first].name), text_cell(result.factors[coupling.second].name),
         text_cell(identification_of(result).sizes[coupling.group].name), count_cell(coupling.deforming_poses)});
  }
  return table;
}

}  // namespace

std::vector<Table> identification_tables(const StoredResult& result, const TableOptions&) {
  std::vector<Table> tables{verdict_table(result)};
  if (!identification_of(result).couplings.empty()) tables.push_back(coupling_rows(result));
  return tables;
}

}  // namespace poesy
