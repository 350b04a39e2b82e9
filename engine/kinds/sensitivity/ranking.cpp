#include "engine/kinds/sensitivity/ranking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "engine/base/error.h"
#include "engine/kinds/sensitivity/fidelity.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/linearity.h"
#include "engine/kinds/sensitivity/separation.h"
#include "engine/stats/indices.h"
#include "engine/stats/rank_correlation.h"

namespace poesy::sensitivity {
namespace {

/// The positions of the errors in the order that the user chose.
std::vector<std::size_t> ordered(const StoredResult& result, std::size_t response, RowOrder order) {
  const Result& found = sensitivity_of(result);
  const auto key = [&](std::size_t p) {
    double value = 0.0;
    if (order == RowOrder::effect) value = effect(result, response, p);
    if (order == RowOrder::index) value = shown_indices(result).value(response, p) * display(result.factors[p]).si;
    if (order == RowOrder::not_converged) value = share_not_converged(found, p);
    return std::isnan(value) ? -std::numeric_limits<double>::infinity() : value;
  };
  std::vector<std::size_t> rows = positions(found.factors());
  if (order == RowOrder::name) {
    std::ranges::stable_sort(rows, {}, [&](std::size_t p) { return result.factors[p].name; });
  } else {
    std::ranges::stable_sort(rows, std::ranges::greater(), key);
  }
  return rows;
}

/// The effects of errors in one of two results that are compared, on the response by which errors are ranked, SI. Only
/// errors that both results have are listed.
struct Ranking {
  std::vector<double> effects;  ///< effect of each error; 0: none; NaN: not known
  std::string metric;           ///< name of the metric that the result uses
  NamedUnit response;           ///< the response by which errors are ranked
};

Ranking ranking_of(const RankedResult& ranked, const std::vector<std::size_t>& factors) {
  const StoredResult& result = ranked.result;
  const std::size_t r = response_named(result, ranked.response);
  const GlobalIndices shown = shown_indices(result);
  Ranking ranking{{}, result.metric, result.responses[r]};
  for (const std::size_t p : factors) {
    const double index = without_rounding(result, shown.value(r, p), r, p);
    ranking.effects.push_back(index * result.factor_sigma[p]);
  }
  return ranking;
}

/// A cell with the rank of an error: one plus the number of errors with a larger effect.
Cell rank_cell(const Ranking& ranking, std::size_t at) {
  if (std::isnan(ranking.effects[at])) return text_cell("");
  const auto larger = [&](double effect) { return effect > ranking.effects[at]; };
  return count_cell(1 + static_cast<std::uint64_t>(std::ranges::count_if(ranking.effects, larger)));
}

/// Extends the list `columns` by columns with the rank and the effect of each error. letter: the result, A or B.
/// by_metric: whether headings name the metric of the result instead of the letter. The columns keep a reference to the
/// ranking.
void add_columns(std::vector<FilledColumn>& columns, char letter, const Ranking& ranking, bool by_metric) {
  const std::string suffix = letter == 'A' ? "_a" : "_b";
  const NamedUnit& response = ranking.response;
  const std::string in = fmt::format(" in {}", letter);
  // Narrow tables omit the rank in A first, because the rows are in the order of A.
  const int dispensable = letter == 'A' ? 2 : 1;
  columns.push_back({number_column("rank" + suffix, "rank" + (by_metric ? ", " + ranking.metric : in), "", dispensable),
                     [&ranking](std::size_t n) { return rank_cell(ranking, n); }});
  columns.push_back(
      {number_column("effect" + suffix, response.name + (by_metric ? ", " + ranking.metric + " metric" : in),
                     unit_text(response)),
       [&ranking](std::size_t n) { return value_cell(ranking.effects[n], ranking.response); }});
}

/// The number of errors whose effect is known in both rankings.
std::size_t known_in_both(const Ranking& a, const Ranking& b) {
  std::size_t known = 0;
  for (std::size_t n = 0; n < a.effects.size(); ++n) known += !std::isnan(a.effects[n]) && !std::isnan(b.effects[n]);
  return known;
}

std::string tau_text(double tau, std::size_t errors) {
  if (std::isnan(tau))
    return "Kendall's tau of the two rankings is not known: too few errors have a known effect in both.";
  return fmt::format(
      "Kendall's tau of the two rankings is {}, over {}: 1 where they have the same order, 0 where one says nothing of "
      "the other, -1 where one is the other reversed.",
      number_text(tau, 2), counted(errors, "error", "errors"));
}

constexpr std::string_view kWhyMetricsDiffer =
    "The published metric weighs radians against metres, so its ranking depends on the unit of length and on where the "
    "base frame is; the platform's metric measures how far its points move, which depends on neither.";

std::vector<std::string> remarks(const RankedResult& a, const RankedResult& b, double tau, std::size_t errors) {
  std::vector<std::string> list{tau_text(tau, errors)};
  if (differ_in_metric(a.result, b.result)) {
    list.emplace_back(kWhyMetricsDiffer);
  } else if (a.result.metric == b.result.metric && a.result.metric_points != b.result.metric_points) {
    list.emplace_back("The two metrics have different points of the platform, and so different effects.");
  }
  const auto names_a = names_of(a.result.factors);
  const auto names_b = names_of(b.result.factors);
  for (const auto& [letter, only] : {std::pair('A', only_in(names_a, names_b)), {'B', only_in(names_b, names_a)}}) {
    if (!only.empty()) list.push_back(fmt::format("Only in {}: {}.", letter, fmt::join(only, ", ")));
  }
  return list;
}

/// The errors that both results have, in the order that `order` gives them in result A.
Common errors_in_order(const RankedResult& a, const RankedResult& b, RowOrder order) {
  Common both = common(names_of(a.result.factors), names_of(b.result.factors));
  if (both.empty()) {
    throw InputError({.file = b.path}, fmt::format("has no error in common with {}", a.path),
                     "compare two results that share some");
  }
  const std::vector<std::size_t> rows = ranked_errors(a.result, a.response, order).rows;
  std::ranges::sort(both, {}, [&](const auto& one) { return std::ranges::find(rows, one.first) - rows.begin(); });
  return both;
}

/// The order in which narrow tables omit columns: higher numbers first. The published index is omitted first, then the
/// indices for other responses, beginning with the last response, then the rank and the other columns of this list.
enum Dispensable : int { kIndexChange = 1, kNotConverged = 2, kRank = 3, kFirstOther = 4 };

/// The headline's responses (those that a summary shows) whose unit is not "1", without the response by which errors
/// are ranked.
std::vector<std::size_t> other_responses(const StoredResult& result, std::size_t ranking) {
  std::vector<std::size_t> others;
  for (const std::size_t r : varying_first(result, result.headline)) {
    if (r != ranking && dimension_of(result.responses[r].unit) != Dimension::number) others.push_back(r);
  }
  return others;
}

using Columns = std::vector<FilledColumn>;

/// Extends the list `columns` by columns with an index and both ends of its interval.
void add_index(Columns& columns, const StoredResult& result, std::size_t r, const std::string& name,
               const std::string& heading, int dispensable) {
  const GlobalIndices shown = shown_indices(result);
  columns.push_back(index_column(result, shown.value, r, name, heading, dispensable));
  columns.push_back(index_column(result, shown.low, r, name + "_low", "low", dispensable));
  columns.push_back(index_column(result, shown.high, r, name + "_high", "high", dispensable));
}

/// The columns of the table of ranked errors. Keeps references to both arguments.
Columns ranked_columns(const StoredResult& result, const RankedErrors& ranked) {
  const std::size_t response = ranked.response;
  const Unit& unit = display(result.responses[response]);
  Columns list{rank_column(result, ranked, kRank), name_column(result.factors, "error")};
  list.push_back({number_column("effect", "effect", unit.name), [&result, &unit, response](std::size_t p) {
                    return index_cell(shown_indices(result).value(response, p), result.factor_sigma[p] / unit.si,
                                      index_rounding(result, response, p));
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
  if (!is_first_order(result)) {
    list.push_back({percent_column("index_change", "at a tenth", kIndexChange), [&result, response](std::size_t p) {
                      return change_cell(sensitivity_of(result).index_change(response, p));
                    }});
  }
  list.push_back({percent_column("not_converged", "not converged", kNotConverged),
                  [&](std::size_t p) { return percent_cell(share_not_converged(sensitivity_of(result), p)); }});
  list.push_back(
      index_column(result, sensitivity_of(result).global, response, "index_published", "published", dispensable));
  return list;
}

std::vector<std::string> ranked_notes(const StoredResult& result, const RankedErrors& ranked) {
  std::vector<std::string> notes{
      fmt::format(
          "index: scatter of {} per scatter of the error (standard deviations), mean over the poses plus spread "
          "between them; low, high: its {:.3g} % interval",
          result.responses[ranked.response].name, 100.0 * sensitivity_of(result).conf_level),
      "published: the index as the literature estimates it, which counts the noise of sampling as spread between "
      "poses; index is without that noise",
      "effect: index \u00d7 sigma, the scatter that an error of the study's sigma causes; the rank goes by it, because "
      "indices per mm and per deg do not compare"};
  if (!is_first_order(result)) {
    notes.emplace_back(
        "at a tenth: what the index changes by if the error is a tenth as large, from the same draws; where it "
        "changes, the index says something about the size studied and no other");
  }
  notes.push_back(index_change_text(result, ranked.response));
  notes.emplace_back("not converged: share of the samples whose solve did not settle");
  return notes;
}

/// A note on how much the ranking changes if the points of the platform's metric are moved. Empty if the result does
/// not contain this.
std::string radius_note(const StoredResult& result, std::size_t response) {
  const auto& tau = sensitivity_of(result).radius_tau;
  if (tau.empty() || std::isnan(tau(0, response)) || std::isnan(tau(1, response))) return {};
  return fmt::format(
      "ranked by {} to first order, with the metric's points as they are and at half and twice their distance from "
      "their middle: Kendall's tau of both rankings with the first is {:.2f} and {:.2f} (1: the same order)",
      result.responses[response].name, tau(0, response), tau(1, response));
}

/// A note on how often intervals from so few samples contain the true index; empty if there are enough samples. If the
/// distribution of a response is skewed, as that of a norm or of the square of an error, few samples are in its tail,
/// and intervals are too narrow.
std::string few_samples_note(const StoredResult& result, std::size_t response) {
  constexpr std::uint64_t kEnoughOfNorms = 200;
  constexpr std::uint64_t kEnoughOfSquares = 1000;
  constexpr double kSquare = -0.5;  // an error with an index change below this acts by its square; an index that is
                                    // proportional to size changes by -90 %
  const Result& found = sensitivity_of(result);
  if (found.solves.empty()) return {};
  const std::uint64_t samples = std::ranges::min(found.solves, {}, &SolveCounts::total).total();
  const bool has_square =
      std::ranges::any_of(found.index_change.row(response), [](double change) { return change < kSquare; });
  if (samples >= (has_square ? kEnoughOfSquares : kEnoughOfNorms)) return {};
  return fmt::format(
      "{} at each pose are few: intervals of 95 % of a norm hold the local index in 91 % of all cases with 20 samples, "
      "92 % with 50 and 94 % with 200, of an error that acts by its square in 79, 84 and 90 %, and 94 % with 1000",
      counted(samples, "sample", "samples"));
}

/// A note on why some cells of the table have no number; empty if all have one.
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
  const std::string too_small = rounding_note(table);
  if (!varies(result, ranked.response) && too_small.empty()) {
    table.caption = constant_text(result.responses[ranked.response]);
  }
  for (const std::string& note :
       {radius_note(result, ranked.response), few_samples_note(result, ranked.response), too_small}) {
    if (!note.empty()) table.notes.push_back(note);
  }
  return table;
}

}  // namespace

GlobalIndices shown_indices(const StoredResult& result) {
  const Result& found = sensitivity_of(result);
  return {found.global_corrected, found.global_corrected_ci_low, found.global_corrected_ci_high};
}

double relative_reach(const GlobalIndices& indices, std::size_t response, std::size_t factor) {
  const double index = indices.value(response, factor);
  return std::max(indices.high(response, factor) - index, index - indices.low(response, factor)) / index;
}

double index_rounding(const StoredResult& result, std::size_t response, std::size_t factor) {
  return index_rounding(sensitivity_of(result), response, result.factor_sigma[factor]);
}

double without_rounding(const StoredResult& result, double index, std::size_t response, std::size_t factor) {
  return told_from_rounding(index, index_rounding(result, response, factor));
}

bool has_effect(const StoredResult& result, std::size_t response, std::size_t factor) {
  return has_effect(shown_indices(result).value(response, factor), index_rounding(result, response, factor));
}

double effect(const StoredResult& result, std::size_t response, std::size_t factor) {
  return shown_indices(result).value(response, factor) * result.factor_sigma[factor];
}

FilledColumn index_column(const StoredResult& result, const Result::Indices& values, std::size_t response,
                          std::string name, std::string heading, int dispensable) {
  const Unit& unit = display(result.responses[response]);
  return {number_column(std::move(name), std::move(heading), fmt::format("{}/unit", unit.name), dispensable),
          [&result, &values, &unit, response](std::size_t p) {
            return index_cell(values(response, p), display(result.factors[p]).si / unit.si,
                              index_rounding(result, response, p));
          }};
}

double share_not_converged(const Result& result, std::size_t factor) {
  const SolveCounts solves = total_of(result.solves.row(factor));
  return solves.total() == 0 ? 0.0 : static_cast<double>(solves.not_converged()) / static_cast<double>(solves.total());
}

RankedErrors ranked_errors(const StoredResult& result, std::string_view response, RowOrder order) {
  RankedErrors found{response_named(result, response), {}, std::vector<std::size_t>(sensitivity_of(result).factors())};
  const std::vector<std::size_t> by_effect = ordered(result, found.response, RowOrder::effect);
  for (std::size_t n = 0; n < by_effect.size(); ++n) found.ranks[by_effect[n]] = n + 1;
  found.rows = order == RowOrder::effect ? by_effect : ordered(result, found.response, order);
  return found;
}

TwoRankings two_rankings(const RankedResult& a, const RankedResult& b, RowOrder order) {
  check_comparable(a.result, a.path, b.result, b.path);
  std::vector<std::size_t> of_a;
  std::vector<std::size_t> of_b;
  for (const auto& [pa, pb] : errors_in_order(a, b, order)) {
    of_a.push_back(pa);
    of_b.push_back(pb);
  }
  const Ranking first = ranking_of(a, of_a);
  const Ranking second = ranking_of(b, of_b);
  const bool by_metric = differ_in_metric(a.result, b.result);
  Table table{.name = "rankings",
              .caption = "Two rankings: the effect of each error at the size that its study gives it",
              .columns = {},
              .ranked = true};
  std::vector<FilledColumn> columns{
      {text_column("error", "error"), [&](std::size_t n) { return text_cell(a.result.factors[of_a[n]].name); }}};
  add_columns(columns, 'A', first, by_metric);
  add_columns(columns, 'B', second, by_metric);
  fill(table, positions(of_a.size()), columns);
  const double tau = kendall_tau(first.effects, second.effects);
  return {std::move(table), tau, remarks(a, b, tau, known_in_both(first, second))};
}

FilledColumn rank_column(const StoredResult& result, const RankedErrors& ranked, int dispensable) {
  return {number_column("rank", "rank", "", dispensable),
          [&](std::size_t p) { return varies(result, ranked.response) ? count_cell(ranked.ranks[p]) : text_cell(""); }};
}

std::vector<std::size_t> responses_without_effect(const StoredResult& result) {
  const Result& found = sensitivity_of(result);
  std::vector<std::size_t> list;
  for (std::size_t r = 0; r < found.responses(); ++r) {
    bool is_known = false;
    bool any = false;
    for (std::size_t p = 0; p < found.factors(); ++p) {
      is_known = is_known || !std::isnan(found.global(r, p));
      any = any || has_effect(result, r, p);
    }
    if (is_known && !any) list.push_back(r);
  }
  return list;
}

std::vector<Table> sensitivity_tables(const StoredResult& result, const TableOptions& options) {
  const RankedErrors ranked = ranked_errors(result, options.ranked_by, options.order);
  std::vector<Table> tables{ranked_table(result, ranked)};
  if (sensitivity_of(result).separation) tables.push_back(separation_table(result, ranked));
  if (sensitivity_of(result).fidelity) tables.push_back(fidelity_table(result, ranked));
  return tables;
}

}  // namespace poesy::sensitivity
