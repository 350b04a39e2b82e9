#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/report/display.h"
#include "engine/report/index_change.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

/// Which columns go first where the room does not suffice: other responses, from the last, then the rank.
enum Dispensable : int { kIndexChange = 1, kNotConverged = 2, kRank = 3, kFirstOther = 4 };

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
  const GlobalIndices shown = shown_indices(result);
  const std::size_t at = r * result.factors.size() + p;
  const double scale = display(result.factors[p]).si / display(result.responses[r]).si;
  const double rounding = index_rounding(result, r, p);
  for (const double value : {shown.value[at], shown.low[at], shown.high[at]}) {
    row.push_back(index_cell(value, scale, rounding));
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
  if (has_index_changes(result)) list.push_back(percent_column("index_change", "at a tenth", kIndexChange));
  list.push_back(percent_column("not_converged", "not converged", kNotConverged));
  if (has_corrected_indices(result)) {
    list.push_back(
        number_column("index_published", "published", fmt::format("{}/unit", display(response).name), dispensable));
  }
  return list;
}

std::vector<Cell> row(const StoredResult& result, const RankedErrors& ranked, std::size_t p,
                      const std::vector<std::size_t>& others) {
  const Unit& unit = display(result.factors[p]);
  const double sigma = result.factor_sigma[p] / unit.si;
  const double si = display(result.responses[ranked.response]).si;
  const double rounding = index_rounding(result, ranked.response, p);
  const std::size_t at = ranked.response * result.factors.size() + p;
  std::vector<Cell> cells{count_cell(ranked.ranks[p]), text_cell(result.factors[p].name),
                          index_cell(shown_indices(result).value[at], result.factor_sigma[p] / si, rounding)};
  add_index_cells(cells, result, ranked.response, p);
  cells.push_back(number_cell(sigma));
  cells.push_back(text_cell(unit.name));
  for (const std::size_t r : others) add_index_cells(cells, result, r, p);
  if (has_index_changes(result)) cells.push_back(change_cell(result.sensitivity.index_change[at]));
  cells.push_back(percent_cell(share_not_converged(result.sensitivity, p)));
  if (has_corrected_indices(result)) {
    cells.push_back(index_cell(result.sensitivity.global[at], unit.si / si, rounding));
  }
  return cells;
}

std::vector<std::string> notes(const StoredResult& result, const RankedErrors& ranked) {
  std::vector<std::string> list{fmt::format(
      "index: scatter of {} per scatter of the error (standard deviations), mean over the poses plus spread "
      "between them; low, high: its {:.3g} % interval",
      result.responses[ranked.response].name, 100.0 * result.sensitivity.conf_level)};
  if (has_corrected_indices(result)) {
    list.emplace_back(
        "published: the index as the literature estimates it, which counts the noise of sampling as spread between "
        "poses; index is without that noise");
  } else {
    list.push_back(
        fmt::format("index is the published estimator, which counts the noise of sampling as spread between "
                    "poses, because an older poesy ({}) wrote this result",
                    result.poesy_version));
  }
  list.emplace_back(
      "effect: index x sigma, the scatter that an error of the study's sigma causes; the rank goes by it, because "
      "indices per mm and per deg do not compare");
  if (has_index_changes(result)) {
    list.emplace_back(
        "at a tenth: what the index changes by if the error is a tenth as large, from the same draws; where it "
        "changes, the index says something about the size studied and no other");
    list.push_back(index_change_text(result, ranked.response));
  }
  list.emplace_back("not converged: share of the samples whose solve did not settle");
  return list;
}

/// How the ranking changes with the points of the platform's metric; empty where the result does not say it.
std::string radius_note(const StoredResult& result, std::size_t response) {
  const std::vector<double>& tau = result.sensitivity.radius_tau;
  const std::size_t responses = result.responses.size();
  if (tau.empty() || std::isnan(tau[response]) || std::isnan(tau[responses + response])) return {};
  return fmt::format(
      "ranked by {} to first order, with the metric's points as they are and at half and twice their distance from "
      "their middle: Kendall's tau of both rankings with the first is {:.2f} and {:.2f} (1: the same order)",
      result.responses[response].name, tau[response], tau[responses + response]);
}

/// Why some cells hold no number; empty where none is so.
std::string rounding_note(const Table& table) {
  const auto is_rounding = [](const Cell& cell) { return cell.text == kTooSmall; };
  const bool any = std::ranges::any_of(
      table.rows, [&](const std::vector<Cell>& row) { return std::ranges::any_of(row, is_rounding); });
  if (!any) return {};
  return fmt::format(
      "{}: the error is so small that its effect cannot be told from the rounding of the solves; study "
      "larger errors",
      kTooSmall);
}

}  // namespace

Table ranked_table(const StoredResult& result, const RankedErrors& ranked) {
  const NamedUnit& response = result.responses[ranked.response];
  const std::vector<std::size_t> others = other_responses(result, ranked.response);
  Table table{.name = "ranked",
              .caption = fmt::format("Effect of each error on {} at the size the study gives it", response.name),
              .columns = columns(result, ranked.response, others),
              .rows = {},
              .notes = notes(result, ranked),
              .ranked = true};
  for (const std::size_t p : ranked.rows) table.rows.push_back(row(result, ranked, p, others));
  for (std::string note : {radius_note(result, ranked.response), rounding_note(table)}) {
    if (!note.empty()) table.notes.push_back(std::move(note));
  }
  return table;
}

}  // namespace poesy
