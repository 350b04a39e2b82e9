#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/kinds/sobol/groups.h"
#include "engine/kinds/sobol/kind.h"
#include "engine/kinds/sobol/result.h"
#include "engine/report/display.h"
#include "engine/report/sources.h"
#include "engine/report/tables.h"
#include "engine/schema/settings.h"

namespace poesy::sobol {
namespace {

constexpr std::size_t kMostPairs = 10;  ///< largest number of pairs in a table

/// The word for what has an index in a result: "group" if errors are joined, otherwise "error".
std::string word(const Result& found) { return found.joined ? "group" : "error"; }

double or_least(double value) { return std::isnan(value) ? -std::numeric_limits<double>::infinity() : value; }

/// Positions ordered by their shares, largest first and NaN last.
std::vector<std::size_t> by_size(std::span<const double> shares) {
  std::vector<std::size_t> order = positions(shares.size());
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t g) { return or_least(shares[g]); });
  return order;
}

/// The shares that rank groups: Shapley effects if there are any, otherwise total indices.
std::span<const double> ranked_shares(const Result& found, std::size_t r) {
  return (found.Sh.empty() ? found.aggregated.ST : found.Sh).value.row(r);
}

/// The groups in the order that the user chose. Indices here are shares without a unit, so RowOrder::index is the same
/// as RowOrder::effect.
std::vector<std::size_t> ordered(const Result& found, std::size_t r, RowOrder order) {
  std::vector<std::size_t> rows = by_size(ranked_shares(found, r));
  if (order == RowOrder::study) rows = positions(found.groups());
  if (order == RowOrder::name) {
    std::ranges::stable_sort(rows, {}, [&](std::size_t g) { return found.group_names[g]; });
  }
  return rows;
}

FilledColumn group_column(const Result& found) {
  return {text_column(word(found), word(found)), [&](std::size_t g) { return text_cell(found.group_names[g]); }};
}

FilledColumn share_column(std::string name, std::string heading, std::span<const double> shares, int dispensable = 0) {
  return {number_column(std::move(name), std::move(heading), "", dispensable),
          [shares](std::size_t g) { return number_cell(shares[g]); }};
}

/// Appends to `columns` the shares of the variance of response r, and the ends of their intervals.
void append_shares(std::vector<FilledColumn>& columns, const std::string& name,
                   const Shares<axis::Response, axis::ErrorGroup>& shares, std::size_t r) {
  columns.push_back(share_column(name, name, shares.value.row(r)));
  columns.push_back(share_column(name + "_low", "low", shares.ci_low.row(r), 1));
  columns.push_back(share_column(name + "_high", "high", shares.ci_high.row(r), 1));
}

/// Columns with S1, ST, their intervals, and the difference ST - S1.
std::vector<FilledColumn> index_columns(const Result& found, std::size_t r) {
  const auto& [conf_level, S1, ST] = found.aggregated;
  std::vector<FilledColumn> columns{group_column(found)};
  append_shares(columns, "S1", S1, r);
  append_shares(columns, "ST", ST, r);
  columns.push_back(
      {number_column("interaction", "ST - S1"),
       [first = S1.value.row(r), total = ST.value.row(r)](std::size_t g) { return number_cell(total[g] - first[g]); }});
  return columns;
}

double sum_of(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

std::string sums_text(const Result& found, std::size_t r) {
  const double total = sum_of(found.aggregated.ST.value.row(r));
  if (std::isnan(total)) {
    return fmt::format("- for a {} with errors that are correlated with others outside it", word(found));
  }
  return fmt::format("the S1 of all add up to {}, their ST to {}: what is missing from 1, or beyond it, is interaction",
                     number_text(sum_of(found.aggregated.S1.value.row(r)), 3), number_text(total, 3));
}

std::string without_sign_text(const std::string& responses, bool several) {
  return fmt::format(
      "{} no sign, so {} not additive even where the mechanism is linear: a small S1 does not mean a small share. "
      "Judge "
      "an error by its ST, or by the index of a vector with a sign",
      responses + (several ? " have" : " has"), several ? "they are" : "it is");
}

Table response_table(const StoredResult& result, std::size_t r, RowOrder order) {
  const Result& found = sobol_of(result);
  Table table{
      .name = "sobol_" + result.responses[r].name,
      .caption = fmt::format("{}: shares of its variance, over {}", result.responses[r].name,
                             counted(result.poses.size(), "pose", "poses")),
      .columns = {},
      .notes = {fmt::format("S1: the share that it makes alone; ST: with all its interactions; {} intervals; {}",
                            percent_text(found.aggregated.conf_level), sums_text(found, r))},
      .ranked = true};
  if (found.without_sign(r) != 0) table.notes.push_back(without_sign_text(result.responses[r].name, false));
  std::vector<FilledColumn> columns = index_columns(found, r);
  if (!found.Sh.empty()) {
    append_shares(columns, "Sh", found.Sh, r);
    table.notes.emplace_back(
        "Sh: Shapley effect, in which what is made together is divided evenly; they add up to 1, also where errors are "
        "correlated");
  }
  if (!varies(result, r)) {
    table.caption = constant_text(result.responses[r]);
    table.notes.clear();
  }
  fill(table, ordered(found, r, order), columns);
  return table;
}

bool vector_varies(const Result& found, std::size_t v) {
  return found.vector_varies.empty() || found.vector_varies(v) != 0;
}

/// A note like "displacement and delta_mu_21_omega do not vary, so no error has a share of them"; empty if all vectors
/// vary.
std::string constant_vectors_text(const Result& found) {
  std::vector<std::string> names;
  for (std::size_t v = 0; v < found.vectors.size(); ++v) {
    if (!vector_varies(found, v)) names.push_back(found.vectors[v]);
  }
  if (names.empty()) return {};
  const bool one = names.size() == 1;
  return fmt::format("{} {} not vary, so no {} has a share of {}", some_names(names), one ? "does" : "do", word(found),
                     one ? "it" : "them");
}

/// The table of total indices of all vectors, with a column for each vector. The lines are ordered by the first vector
/// that varies.
Table vectors_table(const StoredResult& result) {
  const Result& found = sobol_of(result);
  const std::vector<std::size_t> vectors = positions(found.vectors.size());
  const auto first = std::ranges::find_if(vectors, [&](std::size_t v) { return vector_varies(found, v); });
  const auto& ST = found.of_vectors.ST.value;
  std::vector<FilledColumn> columns{group_column(found)};
  for (const std::size_t v : vectors) {
    columns.push_back(share_column("ST_" + std::to_string(v), found.vectors[v], ST.row(v)));
  }
  Table table{.name = "vectors",
              .caption = "Vectors with signs: total index of the sum of their components' variances",
              .columns = {},
              .notes = {"a vector of a linear mechanism is additive: its indices are then shares of its mean square"},
              .ranked = true};
  if (std::string text = constant_vectors_text(found); !text.empty()) table.notes.push_back(std::move(text));
  fill(table, by_size(ST.row(first == vectors.end() ? 0 : *first)), columns);
  return table;
}

/// The table of the pairs with the largest second-order indices on a response.
Table pairs_table(const StoredResult& result, std::size_t r) {
  const Result& found = sobol_of(result);
  std::vector<GroupPair> pairs = group_pairs(found.groups());
  std::ranges::stable_sort(pairs, std::ranges::greater(),
                           [&](const GroupPair& pair) { return or_least(found.S2.value(r, pair.first, pair.second)); });
  Table table{.name = "pairs_" + result.responses[r].name,
              .caption = fmt::format("{}: the pairs with the largest interaction", result.responses[r].name),
              .columns = {},
              .notes = {"S2: the share of the variance that two make together and neither makes alone"}};
  if (pairs.size() > kMostPairs) {
    pairs.resize(kMostPairs);
    table.notes.push_back("the others are in sobol_pairs_" + result.responses[r].name + ".csv ('poesy export')");
  }
  const auto number = [&](std::string name, std::string heading, const auto& values) {
    return FilledColumn{number_column(std::move(name), std::move(heading)),
                        [&](std::size_t k) { return number_cell(values(r, pairs[k].first, pairs[k].second)); }};
  };
  fill(
      table, positions(pairs.size()),
      {{text_column("first", word(found)), [&](std::size_t k) { return text_cell(found.group_names[pairs[k].first]); }},
       {text_column("second", "with"), [&](std::size_t k) { return text_cell(found.group_names[pairs[k].second]); }},
       number("S2", "S2", found.S2.value),
       number("S2_low", "low", found.S2.ci_low),
       number("S2_high", "high", found.S2.ci_high)});
  return table;
}

using SharesOfResponses = Shares<axis::Response, axis::ErrorGroup>;

/// The shares of all responses, one response after the other in the order of the page.
std::vector<double> of_responses(const StoredResult& result, const SharesOfResponses::Values& values) {
  std::vector<double> list;
  for (const std::size_t r : response_order(result)) {
    const std::span row = values.row(r);
    list.insert(list.end(), row.begin(), row.end());
  }
  return list;
}

/// A series of bars, one for each group.
struct BarSeries {
  std::string label;                ///< name of the series; shown only if there are several
  const SharesOfResponses& shares;  ///< shares that the bars show
};

/// Bars with shares of the variance of each response. name: prefix of the names of the page's arrays.
Bars share_bars(const StoredResult& result, ArrayPool& pool, const std::string& name,
                const std::vector<BarSeries>& series) {
  const auto all = [&](const std::string& array, SharesOfResponses::Values SharesOfResponses::*part) {
    std::vector<double> list;
    for (const BarSeries& one : series) {
      const std::vector<double> values = of_responses(result, one.shares.*part);
      list.insert(list.end(), values.begin(), values.end());
    }
    return pool.add(array, list);
  };
  const std::vector<std::size_t> responses = response_order(result);
  Bars bars{{{"response", names_of(result.responses, responses)}},
            {{"share of the variance", std::vector<std::vector<std::string>>(responses.size(), {""}),
              all(name, &SharesOfResponses::value), all(name + "_low", &SharesOfResponses::ci_low),
              all(name + "_high", &SharesOfResponses::ci_high)}},
            sobol_of(result).group_names};
  if (series.size() == 1) return bars;
  for (const BarSeries& one : series) bars.series.push_back(one.label);
  bars.by_first = true;  // as in the table
  return bars;
}

void add_index_bars(const StoredResult& result, Page& page, Section& section) {
  const Result& found = sobol_of(result);
  add_figure(page, section, "sobol",
             share_bars(result, page.figures.pool, "sobol",
                        {{"ST, with interactions", found.aggregated.ST}, {"S1, alone", found.aggregated.S1}}),
             fmt::format("First-order and total index of each {}.", word(found)));
}

void add_shapley_bars(const StoredResult& result, Page& page, Section& section) {
  const Result& found = sobol_of(result);
  if (found.Sh.empty()) return;
  add_figure(page, section, "shapley", share_bars(result, page.figures.pool, "shapley", {{"Sh", found.Sh}}),
             fmt::format("Shapley effect of each {}: what several make together is divided evenly among them, so the "
                         "effects add up to 1, also where errors are correlated.",
                         word(found)));
}

void add_shares(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const Result& found = sobol_of(result);
  Section& section = page.add_section("which-errors-matter", "Which errors make the scatter");
  section.paragraph(fmt::format(
      "All {} vary at once, with the same values at all {}: a machine is built once. S1 is the share of a response's "
      "variance that an error makes alone, ST its share with all interactions; the thin lines are {} intervals. A "
      "variance is summed over the poses before it is divided.",
      counted(result.factors.size(), "error", "errors"), counted(result.poses.size(), "pose", "poses"),
      percent_text(found.aggregated.conf_level)));
  add_index_bars(result, page, section);
  add_shapley_bars(result, page, section);
  // Tables of all responses but the first; the figure shows these responses only if the reader chooses them.
  std::vector<Table> others;
  for (bool first = true; const Table& table : tables) {
    if (!table.name.starts_with("sobol_")) continue;
    if (first) {
      section.table(table);
    } else {
      others.push_back(table);
    }
    first = false;
  }
  if (!others.empty()) section.folded("The same for every other response", others);
  section.table(tables, "vectors");
}

void add_pairs(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const Result& found = sobol_of(result);
  if (found.S2.empty()) return;
  Section& section = page.add_section("pairs", "Which errors interact");
  HeatMap map{{}, found.group_names, word(found) + ", in the order of the rows", {}};
  for (const std::size_t r : headline_order(result)) {
    if (!varies(result, r)) continue;
    map.layers.push_back({"S2 of " + result.responses[r].name, "",
                          page.figures.pool.add(fmt::format("pairs/{}", r), found.S2.value.row(r)), true});
  }
  if (!map.layers.empty()) {
    add_figure(page, section, "pairs", std::move(map),
               "The share of the variance that two make together and neither makes alone.");
  }
  for (const Table& table : tables) {
    if (table.name.starts_with("pairs_")) section.table(table);
  }
}

SolveTally tally(const StoredResult& result) {
  return {"", {"all errors"}, result.poses.size(), sobol_of(result).solves};
}

ShownCells cells(const StoredResult& result) { return shown_cells(result, 2 * sobol_of(result).groups()); }

/// Adds to the page the section that shows ST and S1 at each pose.
void add_where(const StoredResult& result, Page& page) {
  const Result& found = sobol_of(result);
  const PoseFigures figures(result, cells(result), page);
  Section& section = page.add_section("where", "Where in the workspace");
  figures.add_note(section);
  std::vector<HeatLayer> layers;
  std::vector<Field> fields;
  for (const std::size_t r : figures.responses()) {
    if (!varies(result, r)) continue;
    const NamedUnit& response = result.responses[r];
    const auto& [conf_level, S1, ST] = found.at_poses;
    layers.push_back({"ST of " + response.name, "", figures.add(fmt::format("ST/{}", r), ST.value.row(r))});
    layers.push_back({"S1 of " + response.name, "", figures.add(fmt::format("S1/{}", r), S1.value.row(r))});
    fields.push_back({"ST of " + response.name, "", layers[layers.size() - 2].value, found.group_names});
  }
  if (!layers.empty()) {
    add_figure(page, section, "poses", figures.heat_map(std::move(layers), found.group_names, ""),
               fmt::format("The index of each {} at each pose.", word(found)));
  }
  fields.push_back(figures.not_converged(tally(result).shares_by_pose()));
  figures.add_condition(fields);
  figures.add_workspace(section, std::move(fields));
}

void add_page(const StoredResult& result, std::span<const Table> tables, Page& page) {
  if (sobol_of(result).n.empty()) return;
  add_shares(result, tables, page);
  add_pairs(result, tables, page);
  add_where(result, page);
}

Settling settling(const StoredResult& result) { return {"largest total indices", {"all errors"}, result.headline}; }

void warn(const StoredResult& result, std::vector<std::string>& list) {
  if (std::string text = not_settled_text(result, settling(result)); !text.empty()) list.push_back(std::move(text));
  std::vector<std::string> names;
  for (const std::size_t r : result.headline) {
    if (sobol_of(result).without_sign(r) != 0 && varies(result, r)) names.push_back(result.responses[r].name);
  }
  if (!names.empty()) list.push_back(without_sign_text(some_names(names), names.size() > 1) + ".");
}

/// The shares of errors in the variance of the response by which errors are ranked, and the variance of this response
/// at each pose. The shares are Shapley effects if there are any, because these add up to 1; otherwise total indices.
ErrorShares error_shares(const StoredResult& result) {
  const Result& found = sobol_of(result);
  if (found.n.empty()) return {};
  const std::size_t r = response_named(result, default_ranking(result));
  if (!varies(result, r)) return {};
  const std::string& response = result.responses[r].name;
  const std::span variance = found.variance.row(r);
  return {.what = fmt::format("{} of {}", found.Sh.empty() ? "total index ST" : "Shapley effect", response),
          .values = divided_shares(result, found.group_members, ranked_shares(found, r)),
          .joined = found.joined ? "group" : "",
          .pose_what = "the variance of " + response,
          .at_poses = {variance.begin(), variance.end()}};
}

/// The largest shares as text: "delta_1 (41 %), delta_2 (12 %)".
std::string largest_shares(const Result& found, std::span<const double> shares) {
  constexpr std::size_t kMost = 3;
  const std::vector<std::size_t> order = by_size(shares);
  std::string text;
  for (const std::size_t g : std::span(order).first(std::min(kMost, order.size()))) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", found.group_names[g], percent_text(shares[g]));
  }
  return text;
}

/// The shares that the summary states: total indices or, if a group has none because its errors are correlated with
/// errors of other groups, Shapley effects.
const Shares<axis::Response, axis::ErrorGroup>& summarised(const Result& found, std::size_t r) {
  const auto& ST = found.aggregated.ST;
  return found.Sh.empty() || !std::isnan(sum_of(ST.value.row(r))) ? ST : found.Sh;
}

/// Advice on which errors or groups to make smaller first: the one with the largest share, then the others whose
/// intervals overlap with its interval, by decreasing share. total: whether the shares are total indices.
std::string advice(const Result& found, const Shares<axis::Response, axis::ErrorGroup>& shares, std::size_t r,
                   bool total) {
  const std::vector<std::size_t> order = by_size(shares.value.row(r));
  std::vector<std::string> names;
  for (const std::size_t g : order) {
    if (!(shares.ci_high(r, g) < shares.ci_low(r, order.front()))) names.push_back(found.group_names[g]);
  }
  const std::string what = (found.joined ? "the errors of " : "") + some_names(names);
  return fmt::format("Make {} smaller first{}{}.", what,
                     names.size() > 1 ? ", whose intervals do not tell them apart" : "",
                     total ? "; what has a small total index may be set to its mean" : "");
}

/// The summary at the top of the report, for the response by which errors are ranked. It states summarised() shares,
/// and Shapley effects if there are any.
Answer answer(const StoredResult& result) {
  constexpr double kWide = 0.2;
  const Result& found = sobol_of(result);
  if (found.n.empty()) return {};
  const std::size_t r = response_named(result, default_ranking(result));
  const std::string& response = result.responses[r].name;
  if (!varies(result, r)) return {{"Answer", constant_text(result.responses[r]) + "."}};
  const auto& shares = summarised(found, r);
  const bool total = &shares != &found.Sh;
  const std::size_t top = by_size(shares.value.row(r)).front();
  Answer lines{{"Answer", fmt::format("{} the largest shares of the variance of {} are made by {}.",
                                      total ? "With all interactions"
                                            : "If what several make together is divided evenly (Shapley),",
                                      response, largest_shares(found, shares.value.row(r)))}};
  if (total && !found.Sh.empty()) {
    lines.emplace_back("Divided", fmt::format("What several make together divided evenly (Shapley): {}.",
                                              largest_shares(found, found.Sh.value.row(r))));
  }
  const double alone = sum_of(found.aggregated.S1.value.row(r));
  if (!std::isnan(alone)) {
    lines.emplace_back("Alone or together",
                       fmt::format("{} of the variance is made by single {}s; what is missing from 100 % needs several "
                                   "at once{}.",
                                   percent_text(alone), word(found),
                                   found.without_sign(r) != 0 ? ", as it must where a response has no sign" : ""));
  }
  const double low = shares.ci_low(r, top);
  const double high = shares.ci_high(r, top);
  lines.emplace_back(
      "How sure", fmt::format("The {} interval of the {} of {} is {} to {}.", percent_text(found.aggregated.conf_level),
                              total ? "total index" : "Shapley effect", found.group_names[top], percent_text(low),
                              percent_text(high)));
  const bool wide = !(high - low <= 2.0 * kWide * shares.value(r, top));
  lines.emplace_back(kWhatToDo,
                     wide ? "Take more samples before the order of the largest is relied on: their intervals are wide."
                          : advice(found, shares, r, total));
  return lines;
}

/// The figure of merit by which two results are compared: the root mean square of the response over the samples of all
/// poses.
std::vector<Merit> merits(const StoredResult& result, std::string_view name) {
  const Result& found = sobol_of(result);
  if (name.empty() || found.mean.empty()) return {};
  const std::size_t r = response_named(result, name);
  double sum = 0.0;
  for (std::size_t m = 0; m < result.poses.size(); ++m) sum += found.variance(r, m) + std::pow(found.mean(r, m), 2);
  const NamedUnit& response = result.responses[r];
  return {{.what = fmt::format("root mean square of {}", name),
           .unit = unit_text(response),
           .value = std::sqrt(sum / static_cast<double>(result.poses.size())) / display(response).si}};
}

Comparable comparable(const StoredResult& result, const StoredResult& other) {
  const Result& found = sobol_of(result);
  Comparable all{"response", names_of(result.responses, response_order(result)), word(found), found.group_names};
  const std::vector<std::vector<std::string>> units(all.options.size(), {""});
  const auto add = [&](std::string label, std::string array, const SharesOfResponses& shares) {
    all.quantities.push_back({std::move(label), std::move(array), units, of_responses(result, shares.value),
                              of_responses(result, shares.ci_low), of_responses(result, shares.ci_high)});
  };
  add("total index", "ST", found.aggregated.ST);
  if (!found.Sh.empty() && !sobol_of(other).Sh.empty()) add("Shapley effect", "Sh", found.Sh);
  add("first-order index", "S1", found.aggregated.S1);
  all.ranked = true;
  return all;
}

}  // namespace

std::vector<Table> sobol_tables(const StoredResult& result, const TableOptions& options) {
  const Result& found = sobol_of(result);
  std::vector<Table> tables;
  const std::vector<std::size_t> order = varying_first(result, result.headline);
  for (const std::size_t r : order) tables.push_back(response_table(result, r, options.order));
  if (!found.vectors.empty()) tables.push_back(vectors_table(result));
  for (const std::size_t r : order) {
    if (!found.S2.empty() && varies(result, r)) tables.push_back(pairs_table(result, r));
  }
  return tables;
}

namespace {

MethodWords method(const StoredResult& result) {
  const std::string design = study_setting(result.study_text, "analysis", "design");
  const std::string_view points = design == "\"sobol\"" ? "scrambled Sobol' points"
                                  : design == "\"lhs\"" ? "Latin hypercubes"
                                                        : "independent draws";
  return {fmt::format("First-order and total indices were estimated from {}, by squared differences (Jansen).", points),
          {kJansen}};
}

}  // namespace

constinit const ReportKind kReport{.tally = tally,
                                   .tables = sobol_tables,
                                   .merits = merits,
                                   .sorts = true,
                                   .settling = settling,
                                   .words = [](const StoredResult&) { return StudyWords{.draws = true}; },
                                   .method = method,
                                   .warn = warn,
                                   .answer = answer,
                                   .shown_cells = cells,
                                   .page = add_page,
                                   .error_shares = error_shares,
                                   .comparable = comparable};

}  // namespace poesy::sobol
