#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/kinds/sobol/kind.h"
#include "engine/kinds/sobol/result.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

constexpr std::size_t kMostPairs = 10;  ///< that a table shows

/// "error", or "group" where errors are joined.
std::string word(const SobolResult& found) { return found.joined ? "group" : "error"; }

double or_least(double value) { return std::isnan(value) ? -std::numeric_limits<double>::infinity() : value; }

/// Of the aggregated indices by Shapley effect where there is one, else by total index, the largest first. first: its
/// position in the indices.
std::vector<std::size_t> by_share(const SobolResult& found, std::size_t first) {
  const std::vector<double>& shares = found.Sh.empty() ? found.aggregated.ST : found.Sh;
  std::vector<std::size_t> order = positions(found.groups());
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t g) { return or_least(shares[first + g]); });
  return order;
}

/// The groups by their total index, the largest first. first: its position in the indices.
std::vector<std::size_t> by_total_index(const SobolResult& found, const SobolIndices& indices, std::size_t first) {
  std::vector<std::size_t> order = positions(found.groups());
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [&](std::size_t g) { return or_least(indices.ST[first + g]); });
  return order;
}

/// As the user asked for them; the groups have no index per unit, so this is their total index where he asked for one.
std::vector<std::size_t> ordered(const SobolResult& found, std::size_t first, RowOrder order) {
  std::vector<std::size_t> rows = by_share(found, first);
  if (order == RowOrder::study) rows = positions(found.groups());
  if (order == RowOrder::name) {
    std::ranges::stable_sort(rows, {}, [&](std::size_t g) { return found.group_names[g]; });
  }
  return rows;
}

/// S1 and ST with their intervals, and what lies between them.
std::vector<FilledColumn> index_columns(const SobolResult& found, const SobolIndices& indices, std::size_t first) {
  const auto number = [first](std::string name, std::string heading, const std::vector<double>& values,
                              int dispensable = 0) {
    return FilledColumn{number_column(std::move(name), std::move(heading), "", dispensable),
                        [&values, first](std::size_t g) { return number_cell(values[first + g]); }};
  };
  return {{text_column(word(found), word(found)), [&](std::size_t g) { return text_cell(found.group_names[g]); }},
          number("S1", "S1", indices.S1),
          number("S1_low", "low", indices.S1_ci_low, 1),
          number("S1_high", "high", indices.S1_ci_high, 1),
          number("ST", "ST", indices.ST),
          number("ST_low", "low", indices.ST_ci_low, 1),
          number("ST_high", "high", indices.ST_ci_high, 1),
          {number_column("interaction", "ST - S1"),
           [&indices, first](std::size_t g) { return number_cell(indices.ST[first + g] - indices.S1[first + g]); }}};
}

void append_shapley(std::vector<FilledColumn>& columns, const SobolResult& found, std::size_t first) {
  const auto add = [&](std::string name, std::string heading, const std::vector<double>& values, int dispensable) {
    columns.push_back({number_column(std::move(name), std::move(heading), "", dispensable),
                       [&values, first](std::size_t g) { return number_cell(values[first + g]); }});
  };
  add("Sh", "Sh", found.Sh, 0);
  add("Sh_low", "low", found.Sh_ci_low, 1);
  add("Sh_high", "high", found.Sh_ci_high, 1);
}

double sum_of(const std::vector<double>& values, std::size_t first, std::size_t count) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0.0);
}

std::string sums_text(const SobolResult& found, const SobolIndices& indices, std::size_t first) {
  if (std::isnan(sum_of(indices.ST, first, found.groups()))) {
    return fmt::format("- for a {} with errors that are correlated with others outside it", word(found));
  }
  return fmt::format("the S1 of all add up to {}, their ST to {}: what is missing from 1, or beyond it, is interaction",
                     number_text(sum_of(indices.S1, first, found.groups()), 3),
                     number_text(sum_of(indices.ST, first, found.groups()), 3));
}

std::string without_sign_text(const std::string& responses, bool several) {
  return fmt::format(
      "{} no sign, so {} not additive even where the mechanism is linear: a small S1 does not mean a small share. "
      "Judge "
      "an error by its ST, or by the index of a vector with a sign",
      responses + (several ? " have" : " has"), several ? "they are" : "it is");
}

Table response_table(const StoredResult& result, std::size_t r, RowOrder order) {
  const SobolResult& found = sobol_of(result);
  const std::size_t first = r * found.groups();
  Table table{
      .name = "sobol_" + result.responses[r].name,
      .caption = fmt::format("{}: shares of its variance, over {}", result.responses[r].name,
                             counted(found.poses, "pose", "poses")),
      .columns = {},
      .notes = {fmt::format("S1: the share that it makes alone; ST: with all its interactions; {} intervals; {}",
                            percent_text(found.aggregated.conf_level), sums_text(found, found.aggregated, first))},
      .ranked = true};
  if (found.without_sign[r] != 0) table.notes.push_back(without_sign_text(result.responses[r].name, false));
  std::vector<FilledColumn> columns = index_columns(found, found.aggregated, first);
  if (!found.Sh.empty()) {
    append_shapley(columns, found, first);
    table.notes.emplace_back(
        "Sh: Shapley effect, in which what is made together is divided evenly; they add up to 1, also where errors are "
        "correlated");
  }
  if (!varies(result, r)) {
    table.caption = constant_text(result.responses[r]);
    table.notes.clear();
  }
  fill(table, ordered(found, first, order), columns);
  return table;
}

bool vector_varies(const SobolResult& found, std::size_t v) {
  return found.vector_varies.empty() || found.vector_varies[v] != 0;
}

/// "displacement and delta_mu_21_omega do not vary, so no error has a share of them"; empty where all vary.
std::string constant_vectors_text(const SobolResult& found) {
  std::vector<std::string> names;
  for (std::size_t v = 0; v < found.vectors.size(); ++v) {
    if (!vector_varies(found, v)) names.push_back(found.vectors[v]);
  }
  if (names.empty()) return {};
  const bool one = names.size() == 1;
  return fmt::format("{} {} not vary, so no {} has a share of {}", some_names(names), one ? "does" : "do", word(found),
                     one ? "it" : "them");
}

/// The total index of every vector: one column each, ordered by the first one that varies.
Table vectors_table(const StoredResult& result) {
  const SobolResult& found = sobol_of(result);
  const std::size_t groups = found.groups();
  const std::vector<std::size_t> vectors = positions(found.vectors.size());
  const auto first = std::ranges::find_if(vectors, [&](std::size_t v) { return vector_varies(found, v); });
  std::vector<FilledColumn> columns{
      {text_column(word(found), word(found)), [&](std::size_t g) { return text_cell(found.group_names[g]); }}};
  for (std::size_t v = 0; v < found.vectors.size(); ++v) {
    columns.push_back(
        {number_column("ST_" + std::to_string(v), found.vectors[v]),
         [&found, first = v * groups](std::size_t g) { return number_cell(found.of_vectors.ST[first + g]); }});
  }
  Table table{.name = "vectors",
              .caption = "Vectors with signs: total index of the sum of their components' variances",
              .columns = {},
              .notes = {"a vector of a linear mechanism is additive: its indices are then shares of its mean square"},
              .ranked = true};
  if (std::string text = constant_vectors_text(found); !text.empty()) table.notes.push_back(std::move(text));
  fill(table, by_total_index(found, found.of_vectors, first == vectors.end() ? 0 : *first * groups), columns);
  return table;
}

/// The pairs of a response with the largest second-order index.
Table pairs_table(const StoredResult& result, std::size_t r) {
  const SobolResult& found = sobol_of(result);
  const std::size_t groups = found.groups();
  std::vector<std::size_t> pairs;  // as first * groups + second
  for (std::size_t i = 0; i < groups; ++i) {
    for (std::size_t j = i + 1; j < groups; ++j) pairs.push_back(i * groups + j);
  }
  const std::size_t first = r * groups * groups;
  std::ranges::stable_sort(pairs, std::ranges::greater(),
                           [&](std::size_t pair) { return or_least(found.S2[first + pair]); });
  Table table{.name = "pairs_" + result.responses[r].name,
              .caption = fmt::format("{}: the pairs with the largest interaction", result.responses[r].name),
              .columns = {},
              .notes = {"S2: the share of the variance that two make together and neither makes alone"}};
  if (pairs.size() > kMostPairs) {
    pairs.resize(kMostPairs);
    table.notes.push_back("the others are in sobol_pairs_" + result.responses[r].name + ".csv ('poesy export')");
  }
  const auto number = [first](std::string name, std::string heading, const std::vector<double>& values) {
    return FilledColumn{number_column(std::move(name), std::move(heading)),
                        [&values, first](std::size_t pair) { return number_cell(values[first + pair]); }};
  };
  fill(table, pairs,
       {{text_column("first", word(found)),
         [&, groups](std::size_t pair) { return text_cell(found.group_names[pair / groups]); }},
        {text_column("second", "with"),
         [&, groups](std::size_t pair) { return text_cell(found.group_names[pair % groups]); }},
        number("S2", "S2", found.S2),
        number("S2_low", "low", found.S2_ci_low),
        number("S2_high", "high", found.S2_ci_high)});
  return table;
}

/// Values of the responses in the order of a page, [R x P].
std::vector<double> of_responses(const StoredResult& result, const std::vector<double>& values) {
  const std::size_t groups = sobol_of(result).groups();
  std::vector<double> list;
  for (const std::size_t r : response_order(result)) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(r * groups);
    list.insert(list.end(), begin, begin + static_cast<std::ptrdiff_t>(groups));
  }
  return list;
}

/// One of the bars of each error: values with the ends of their intervals, [R x P] each.
struct BarSeries {
  std::string label;                 ///< not shown where it is the only one
  const std::vector<double>* value;  ///< what is shown
  const std::vector<double>* low;    ///< lower ends
  const std::vector<double>* high;   ///< upper ends
};

/// Bars of shares of the variance for each response. name: of their arrays.
Bars share_bars(const StoredResult& result, ArrayPool& pool, const std::string& name,
                const std::vector<BarSeries>& series) {
  const auto all = [&](const std::string& array, const std::vector<double>* BarSeries::*part) {
    std::vector<double> list;
    for (const BarSeries& one : series) {
      const std::vector<double> values = of_responses(result, *(one.*part));
      list.insert(list.end(), values.begin(), values.end());
    }
    return pool.add(array, list);
  };
  const std::vector<std::size_t> responses = response_order(result);
  Bars bars{
      {{"response", names_of(result.responses, responses)}},
      {{"share of the variance", std::vector<std::vector<std::string>>(responses.size(), {""}),
        all(name, &BarSeries::value), all(name + "_low", &BarSeries::low), all(name + "_high", &BarSeries::high)}},
      sobol_of(result).group_names};
  if (series.size() == 1) return bars;
  for (const BarSeries& one : series) bars.series.push_back(one.label);
  return bars;
}

void add_index_bars(const StoredResult& result, Page& page, Section& section) {
  const SobolResult& found = sobol_of(result);
  const SobolIndices& indices = found.aggregated;
  add_figure(page, section, "sobol",
             share_bars(result, page.figures.pool, "sobol",
                        {{"ST, with interactions", &indices.ST, &indices.ST_ci_low, &indices.ST_ci_high},
                         {"S1, alone", &indices.S1, &indices.S1_ci_low, &indices.S1_ci_high}}),
             fmt::format("First-order and total index of each {}.", word(found)));
}

void add_shapley_bars(const StoredResult& result, Page& page, Section& section) {
  const SobolResult& found = sobol_of(result);
  if (found.Sh.empty()) return;
  add_figure(page, section, "shapley",
             share_bars(result, page.figures.pool, "shapley", {{"Sh", &found.Sh, &found.Sh_ci_low, &found.Sh_ci_high}}),
             fmt::format("Shapley effect of each {}: what several make together is divided evenly among them, so the "
                         "effects add up to 1, also where errors are correlated.",
                         word(found)));
}

void add_shares(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const SobolResult& found = sobol_of(result);
  Section& section = page.add_section("which-errors-matter", "Which errors make the scatter");
  section.paragraph(fmt::format(
      "All {} vary at once, with the same values at all {}: a machine is built once. S1 is the share of a response's "
      "variance that an error makes alone, ST its share with all interactions; the thin lines are {} intervals. A "
      "variance is summed over the poses before it is divided.",
      counted(result.factors.size(), "error", "errors"), counted(found.poses, "pose", "poses"),
      percent_text(found.aggregated.conf_level)));
  add_index_bars(result, page, section);
  add_shapley_bars(result, page, section);
  for (const Table& table : tables) {
    if (table.name.starts_with("sobol_")) section.table(table);
  }
  section.table(tables, "vectors");
}

void add_pairs(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const SobolResult& found = sobol_of(result);
  if (found.S2.empty()) return;
  Section& section = page.add_section("pairs", "Which errors interact");
  HeatMap map{{}, found.group_names, word(found) + ", in the order of the rows", {}};
  for (const std::size_t r : headline_order(result)) {
    if (!varies(result, r)) continue;
    const std::size_t cells = found.groups() * found.groups();
    const auto values = std::span(found.S2).subspan(r * cells, cells);
    map.layers.push_back(
        {"S2 of " + result.responses[r].name, "", page.figures.pool.add(fmt::format("pairs/{}", r), values), true});
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

/// ST and S1 of the errors at each pose.
void add_where(const StoredResult& result, Page& page) {
  const SobolResult& found = sobol_of(result);
  const std::size_t groups = found.groups();
  const PoseFigures figures(result, cells(result), page);
  Section& section = page.add_section("where", "Where in the workspace");
  figures.add_note(section);
  std::vector<HeatLayer> layers;
  std::vector<Field> fields;
  for (const std::size_t r : figures.responses()) {
    if (!varies(result, r)) continue;
    const NamedUnit& response = result.responses[r];
    const auto at_poses = [&](const std::vector<double>& values) {
      return std::span(values).subspan(r * groups * found.poses, groups * found.poses);
    };
    layers.push_back({"ST of " + response.name, "", figures.add(fmt::format("ST/{}", r), at_poses(found.at_poses.ST))});
    layers.push_back({"S1 of " + response.name, "", figures.add(fmt::format("S1/{}", r), at_poses(found.at_poses.S1))});
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
  if (sobol_of(result).poses == 0 || sobol_of(result).groups() == 0) return;
  add_shares(result, tables, page);
  add_pairs(result, tables, page);
  add_where(result, page);
}

Settling settling(const StoredResult& result) { return {"largest total indices", {"all errors"}, result.headline}; }

void warn(const StoredResult& result, std::vector<std::string>& list) {
  if (std::string text = not_settled_text(result, settling(result)); !text.empty()) list.push_back(std::move(text));
  std::vector<std::string> names;
  for (const std::size_t r : result.headline) {
    if (sobol_of(result).without_sign[r] != 0 && varies(result, r)) names.push_back(result.responses[r].name);
  }
  if (!names.empty()) list.push_back(without_sign_text(some_names(names), names.size() > 1) + ".");
}

/// Shapley effects where there are some, for these add up, else total indices; and the variance at each pose.
ErrorShares error_shares(const StoredResult& result) {
  const SobolResult& found = sobol_of(result);
  if (found.groups() == 0 || found.poses == 0) return {};
  const std::size_t r = response_named(result, default_ranking(result));
  if (!varies(result, r)) return {};
  const std::string& response = result.responses[r].name;
  const bool shapley = !found.Sh.empty();
  const std::vector<double>& all = shapley ? found.Sh : found.aggregated.ST;
  return {
      .what = fmt::format("{} of {}", shapley ? "Shapley effect" : "total index ST", response),
      .values = divided_shares(result, found.group_members, std::span(all).subspan(r * found.groups(), found.groups())),
      .joined = found.joined ? "group" : "",
      .pose_what = "the variance of " + response,
      .at_poses = of_row(found.variance, r, found.poses)};
}

/// "delta_1 (41 %), delta_2 (12 %)": the largest of these shares, in this order.
std::string largest_shares(const SobolResult& found, std::span<const double> shares,
                           const std::vector<std::size_t>& order) {
  constexpr std::size_t kMost = 3;
  std::string text;
  for (const std::size_t g : std::span(order).first(std::min(kMost, order.size()))) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", found.group_names[g], percent_text(shares[g]));
  }
  return text;
}

/// Of the response that ranks: by Shapley effects where there are any, else by total indices.
Answer answer(const StoredResult& result) {
  constexpr double kWide = 0.2;
  const SobolResult& found = sobol_of(result);
  const std::size_t groups = found.groups();
  if (found.poses == 0 || groups == 0) return {};
  const std::size_t r = response_named(result, default_ranking(result));
  const std::size_t first = r * groups;
  const std::string& response = result.responses[r].name;
  if (!varies(result, r)) return {{"Answer", constant_text(result.responses[r]) + "."}};
  const SobolIndices& indices = found.aggregated;
  const std::vector<std::size_t> order = by_total_index(found, indices, first);
  const std::size_t top = order.front();
  const auto of_response = [&](const std::vector<double>& values) { return std::span(values).subspan(first, groups); };
  Answer lines{{"Answer", fmt::format("With all interactions the largest shares of the variance of {} are made by {}.",
                                      response, largest_shares(found, of_response(indices.ST), order))}};
  if (!found.Sh.empty()) {
    lines.emplace_back("Divided", fmt::format("What several make together divided evenly (Shapley): {}.",
                                              largest_shares(found, of_response(found.Sh), by_share(found, first))));
  }
  const double alone = sum_of(indices.S1, first, groups);
  if (!std::isnan(alone)) {
    lines.emplace_back("Alone or together",
                       fmt::format("{} of the variance is made by single {}s; what is missing from 100 % needs several "
                                   "at once{}.",
                                   percent_text(alone), word(found),
                                   found.without_sign[r] != 0 ? ", as it must where a response has no sign" : ""));
  }
  const double low = indices.ST_ci_low[first + top];
  const double high = indices.ST_ci_high[first + top];
  lines.emplace_back(
      "How sure", fmt::format("The {} interval of the total index of {} is {} to {}.", percent_text(indices.conf_level),
                              found.group_names[top], percent_text(low), percent_text(high)));
  const bool wide = !(high - low <= 2.0 * kWide * indices.ST[first + top]);
  lines.emplace_back("What to do",
                     wide ? "Take more samples before the order of the largest is relied on: their intervals are wide."
                          : fmt::format("Make {} smaller first; what has a small total index may be set to its mean.",
                                        found.group_names[top]));
  return lines;
}

Comparable comparable(const StoredResult& result, const StoredResult& other) {
  const SobolResult& found = sobol_of(result);
  Comparable all{"response", names_of(result.responses, response_order(result)), word(found), found.group_names};
  const std::vector<std::vector<std::string>> units(all.options.size(), {""});
  const auto add = [&](std::string label, std::string array, const std::vector<double>& value,
                       const std::vector<double>& low, const std::vector<double>& high) {
    all.quantities.push_back({std::move(label), std::move(array), units, of_responses(result, value),
                              of_responses(result, low), of_responses(result, high)});
  };
  const SobolIndices& indices = found.aggregated;
  add("total index", "ST", indices.ST, indices.ST_ci_low, indices.ST_ci_high);
  if (!found.Sh.empty() && !sobol_of(other).Sh.empty()) {
    add("Shapley effect", "Sh", found.Sh, found.Sh_ci_low, found.Sh_ci_high);
  }
  add("first-order index", "S1", indices.S1, indices.S1_ci_low, indices.S1_ci_high);
  all.ranked = true;
  return all;
}

}  // namespace

std::vector<Table> sobol_tables(const StoredResult& result, const TableOptions& options) {
  const SobolResult& found = sobol_of(result);
  std::vector<Table> tables;
  const std::vector<std::size_t> order = varying_first(result, result.headline);
  for (const std::size_t r : order) tables.push_back(response_table(result, r, options.order));
  if (!found.vectors.empty()) tables.push_back(vectors_table(result));
  for (const std::size_t r : order) {
    if (!found.S2.empty() && varies(result, r)) tables.push_back(pairs_table(result, r));
  }
  return tables;
}

constinit const ReportKind kSobolReport{.tally = tally,
                                        .tables = sobol_tables,
                                        .sorts = true,
                                        .settling = settling,
                                        .words = [](const StoredResult&) { return StudyWords{.draws = true}; },
                                        .warn = warn,
                                        .answer = answer,
                                        .shown_cells = cells,
                                        .page = add_page,
                                        .error_shares = error_shares,
                                        .comparable = comparable};

}  // namespace poesy
