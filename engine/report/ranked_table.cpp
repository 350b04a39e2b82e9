#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

/// Which columns go first where the room does not suffice: other responses, from the last, then the rank.
enum Dispensable : int { kNotConverged = 1, kRank = 2, kFirstOther = 3 };

/// The responses of the headline beside the one that ranks, those that have a dimension.
std::vector<std::size_t> other_responses(const StoredResult& result, std::size_t ranking) {
  std::vector<std::size_t> others;
  for (const std::size_t r : result.headline) {
    if (r != ranking && dimension_of(result.responses[r].unit) != Dimension::number) others.push_back(r);
  }
  return others;
}

/// An index and the ends of its interval.
void add_index_columns(std::vector<Column>& columns, const std::string& name, const std::string& heading,
                       const NamedUnit& response, int dispensable) {
  const std::string unit = fmt::format("{}/unit", display(response).name);
  columns.push_back(number_column(name, heading, unit, dispensable));
  columns.push_back(number_column(name + "_low", "low", unit, dispensable));
  columns.push_back(number_column(name + "_high", "high", unit, dispensable));
}

void add_index_cells(std::vector<Cell>& row, const StoredResult& result, std::size_t r, std::size_t p) {
  const SensitivityResult& found = result.sensitivity;
  const std::size_t at = r * found.factors + p;
  const double scale = display(result.factors[p]).si / display(result.responses[r]).si;
  for (const double value : {found.global[at], found.global_ci_low[at], found.global_ci_high[at]}) {
    row.push_back(index_cell(value, scale));
  }
}

std::vector<Column> columns(const StoredResult& result, std::size_t ranking, const std::vector<std::size_t>& others) {
  const NamedUnit& response = result.responses[ranking];
  std::vector<Column> list{number_column("rank", "rank", "", kRank), text_column("error", "error"),
                           number_column("effect", "effect", display(response).name)};
  add_index_columns(list, "index", "index", response, 0);
  list.push_back(number_column("sigma", "sigma"));
  list.push_back(text_column("unit", "unit"));
  int dispensable = kFirstOther;
  for (const std::size_t r : others) {
    const std::string& name = result.responses[r].name;
    add_index_columns(list, "index_" + name, name, result.responses[r], dispensable++);
  }
  list.push_back(percent_column("not_converged", "not converged", kNotConverged));
  return list;
}

std::vector<Cell> row(const StoredResult& result, const RankedErrors& ranked, std::size_t p,
                      const std::vector<std::size_t>& others) {
  const Unit& unit = display(result.factors[p]);
  const double sigma = result.factor_sigma[p] / unit.si;
  const double index = result.sensitivity.global[ranked.response * result.sensitivity.factors + p];
  std::vector<Cell> cells{count_cell(ranked.ranks[p]), text_cell(result.factors[p].name),
                          index_cell(index, result.factor_sigma[p] / display(result.responses[ranked.response]).si)};
  add_index_cells(cells, result, ranked.response, p);
  cells.push_back(number_cell(sigma));
  cells.push_back(text_cell(unit.name));
  for (const std::size_t r : others) add_index_cells(cells, result, r, p);
  cells.push_back(percent_cell(share_not_converged(result.sensitivity, p)));
  return cells;
}

}  // namespace

Table ranked_table(const StoredResult& result, const RankedErrors& ranked) {
  const NamedUnit& response = result.responses[ranked.response];
  const std::vector<std::size_t> others = other_responses(result, ranked.response);
  Table table{
      .name = "ranked",
      .caption = fmt::format("Effect of each error on {} at the size the study gives it", response.name),
      .columns = columns(result, ranked.response, others),
      .rows = {},
      .notes = {fmt::format("index: scatter of {} per scatter of the error (standard deviations), mean over the "
                            "poses plus spread between them; low, high: its {:.3g} % interval",
                            response.name, 100.0 * result.sensitivity.conf_level),
                "effect: index x sigma, the scatter that an error of the study's sigma causes; the rank goes by "
                "it, for indices per mm and per deg do not compare",
                "not converged: share of the samples whose solve did not settle"},
      .ranked = true};
  for (const std::size_t p : ranked.rows) table.rows.push_back(row(result, ranked, p, others));
  return table;
}

}  // namespace poesy
