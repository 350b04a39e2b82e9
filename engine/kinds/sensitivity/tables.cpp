#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "engine/kinds/sensitivity/index_change.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/display.h"
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

using Columns = std::vector<FilledColumn>;

FilledColumn rank_column(const RankedErrors& ranked, int dispensable) {
  return {number_column("rank", "rank", "", dispensable),
          [&ranked](std::size_t p) { return count_cell(ranked.ranks[p]); }};
}

/// An index and the ends of its interval.
void add_index(Columns& columns, const StoredResult& result, std::size_t r, const std::string& name,
               const std::string& heading, int dispensable) {
  const GlobalIndices shown = shown_indices(result);
  columns.push_back(index_column(result, shown.value, r, name, heading, dispensable));
  columns.push_back(index_column(result, shown.low, r, name + "_low", "low", dispensable));
  columns.push_back(index_column(result, shown.high, r, name + "_high", "high", dispensable));
}

/// Refers to both.
Columns ranked_columns(const StoredResult& result, const RankedErrors& ranked) {
  const std::size_t response = ranked.response;
  const Unit& unit = display(result.responses[response]);
  Columns list{rank_column(ranked, kRank), name_column(result.factors, "error")};
  list.push_back({number_column("effect", "effect", unit.name), [&result, &unit, response](std::size_t p) {
                    return index_cell(shown_indices(result).value[response * result.factors.size() + p],
                                      result.factor_sigma[p] / unit.si, index_rounding(result, response, p));
                  }});
  add_index(list, result, response, "index", "index", 0);
  list.push_back({number_column("sigma", "sigma"),
                  [&](std::size_t p) { return value_cell(result.factor_sigma[p], result.factors[p]); }});
  list.push_back(unit_column(result.factors));
  int dispensable = kFirstOther;
  for (const std::size_t r : other_responses(result, response)) {
    const std::string& name = result.responses[r].name;
    add_index(list, result, r, "index_" + name, name, dispensable++);
  }
  if (has_index_changes(result)) {
    list.push_back({percent_column("index_change", "at a tenth", kIndexChange), [&result, response](std::size_t p) {
                      return change_cell(sensitivity_of(result).index_change[response * result.factors.size() + p]);
                    }});
  }
  list.push_back({percent_column("not_converged", "not converged", kNotConverged),
                  [&](std::size_t p) { return percent_cell(share_not_converged(sensitivity_of(result), p)); }});
  if (has_corrected_indices(result)) {
    list.push_back(
        index_column(result, sensitivity_of(result).global, response, "index_published", "published", dispensable));
  }
  return list;
}

std::vector<std::string> ranked_notes(const StoredResult& result, const RankedErrors& ranked) {
  std::vector<std::string> list{fmt::format(
      "index: scatter of {} per scatter of the error (standard deviations), mean over the poses plus spread "
      "between them; low, high: its {:.3g} % interval",
      result.responses[ranked.response].name, 100.0 * sensitivity_of(result).conf_level)};
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
  const std::vector<double>& tau = sensitivity_of(result).radius_tau;
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

Table ranked_table(const StoredResult& result, const RankedErrors& ranked) {
  const std::string& response = result.responses[ranked.response].name;
  Table table{.name = "ranked",
              .caption = fmt::format("Effect of each error on {} at the size the study gives it", response),
              .columns = {},
              .notes = ranked_notes(result, ranked),
              .ranked = true};
  fill(table, ranked.rows, ranked_columns(result, ranked));
  for (std::string note : {radius_note(result, ranked.response), rounding_note(table)}) {
    if (!note.empty()) table.notes.push_back(std::move(note));
  }
  return table;
}

Table separation_table(const StoredResult& result, const RankedErrors& ranked) {
  const SeparationResult& found = *sensitivity_of(result).separation;
  Table table{.name = "separation",
              .caption = "What calibration can remove of each error's effect, to first order, over the poses",
              .columns = {},
              .notes = {"effect: " + sensitivity_of(result).separation_measure,
                        fmt::format("all errors together, at the size the study sets: {} of the effect is removable",
                                    percent_text(found.removable_together))},
              .ranked = true};
  fill(table, ranked.rows,
       {rank_column(ranked, 2),
        name_column(result.factors, "error"),
        {text_column("published_class", "published class", 1),
         [&](std::size_t p) { return text_cell(sensitivity_of(result).published_class[p]); }},
        {percent_column("drive_share", "drive share"),
         [&](std::size_t p) { return percent_cell(found.drive_share[p]); }},
        {percent_column("removable", "removable by calibration"),
         [&](std::size_t p) { return percent_cell(found.removable[p]); }}});
  return table;
}

/// The response where a measure [R x P] of an error has its largest magnitude; none where it has no value.
std::optional<std::size_t> largest(const std::vector<double>& measure, std::size_t factor, std::size_t factors) {
  std::optional<std::size_t> found;
  for (std::size_t r = 0; r * factors < measure.size(); ++r) {
    const double value = std::abs(measure[r * factors + factor]);
    if (!std::isnan(value) && (!found || value > std::abs(measure[*found * factors + factor]))) found = r;
  }
  return found;
}

/// The largest value in percent, and the response where it is. Refers to the result and the measure.
void add_largest(Columns& columns, const StoredResult& result, const std::vector<double>& measure,
                 const std::string& name, int dispensable) {
  const auto value = [&result, &measure](std::size_t p) {
    const auto at = largest(measure, p, sensitivity_of(result).factors);
    return at ? measure[*at * sensitivity_of(result).factors + p] : std::numeric_limits<double>::quiet_NaN();
  };
  columns.push_back({percent_column(name, name), [value](std::size_t p) {
                       return std::isinf(value(p)) ? text_cell("no effect") : percent_cell(value(p));
                     }});
  columns.push_back(
      {text_column(name + "_response", "largest for", dispensable), [&result, &measure, value](std::size_t p) {
         if (std::isinf(value(p))) return text_cell("by the first");
         const auto at = largest(measure, p, sensitivity_of(result).factors);
         return text_cell(at ? result.responses[*at].name : "");
       }});
}

std::string verdict(const FidelityResult& found, std::size_t factor) {
  const std::size_t factors = found.linear.size();
  if (found.linear[factor] == 0) return "not linear";
  return largest(found.nonlinearity, factor, factors) ? "linear" : "no effect";
}

std::vector<std::string> fidelity_notes(const StoredResult& result, const FidelityResult& found) {
  const auto not_linear = std::ranges::count(found.linear, std::uint8_t{0});
  std::vector<std::string> list{
      fmt::format("{} of {} errors are not linear: they differ by more than {:.3g} %, at the size the study sets",
                  not_linear, found.linear.size(), 100.0 * found.linearity),
      "discrepancy: of the index, in percent of the error's largest; nonlinearity: of mean and spread, in percent of "
      "its largest effect"};
  const auto failed = std::accumulate(found.not_converged.begin(), found.not_converged.end(), std::uint64_t{0});
  if (failed > 0) {
    list.push_back(fmt::format("{} at fidelity \"{}\" did not converge", counted(failed, "solve", "solves"),
                               sensitivity_of(result).fidelities[1]));
  }
  return list;
}

Table fidelity_table(const StoredResult& result, const RankedErrors& ranked) {
  const FidelityResult& found = *sensitivity_of(result).fidelity;
  Table table{.name = "fidelity",
              .caption = fmt::format("Fidelity \"{}\" against \"{}\" on the same draws",
                                     sensitivity_of(result).fidelities[1], sensitivity_of(result).fidelities[0]),
              .columns = {},
              .notes = fidelity_notes(result, found),
              .ranked = true};
  Columns columns{rank_column(ranked, 3), name_column(result.factors, "error")};
  add_largest(columns, result, found.relative_discrepancy, "discrepancy", 1);
  add_largest(columns, result, found.nonlinearity, "nonlinearity", 2);
  columns.push_back({text_column("verdict", "verdict"), [&](std::size_t p) { return text_cell(verdict(found, p)); }});
  fill(table, ranked.rows, columns);
  return table;
}

}  // namespace

std::vector<Table> sensitivity_tables(const StoredResult& result, const TableOptions& options) {
  const RankedErrors ranked = ranked_errors(result, options.ranked_by, options.order);
  std::vector<Table> tables{ranked_table(result, ranked)};
  if (sensitivity_of(result).separation) tables.push_back(separation_table(result, ranked));
  if (sensitivity_of(result).fidelity) tables.push_back(fidelity_table(result, ranked));
  return tables;
}

}  // namespace poesy
