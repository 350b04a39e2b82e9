#include "engine/report/html/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/report/display.h"
#include "engine/report/html/parts.h"

namespace poesy {
namespace {

/// The arrays of A, then of B.
std::vector<double> both(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> all = a;
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

Bars bars_of(const Comparison& compared, ArrayPool& pool) {
  Bars bars{{{compared.option_word, compared.options}}, {}, compared.items, {"A", "B"}, compared.ranked};
  for (const ComparedQuantity& quantity : compared.quantities) {
    BarQuantity shown{quantity.label, quantity.units,
                      pool.add(quantity.array, both(quantity.a.value, quantity.b.value))};
    if (!quantity.a.low.empty()) {
      shown.low = pool.add(quantity.array + "_low", both(quantity.a.low, quantity.b.low));
      shown.high = pool.add(quantity.array + "_high", both(quantity.a.high, quantity.b.high));
    }
    bars.quantities.push_back(std::move(shown));
  }
  return bars;
}

/// The first quantity, A against B; its units do not differ by item.
Scatter scatter_of(const Comparison& compared, ArrayPool& pool) {
  const ComparedQuantity& quantity = compared.quantities.front();
  Scatter scatter{{{compared.option_word, compared.options}},
                  {"A", pool.add(quantity.array + "_a", quantity.a.value)},
                  {"B", pool.add(quantity.array + "_b", quantity.b.value)},
                  {},
                  compared.items};
  for (const std::vector<std::string>& unit : quantity.units) scatter.units.push_back(unit.front());
  return scatter;
}

/// From 1, of P items of one option; unknown values come last.
std::vector<std::size_t> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t p) { return std::isnan(values[p]) ? -HUGE_VAL : std::abs(values[p]); };
  std::ranges::stable_sort(order, std::ranges::greater(), key);
  std::vector<std::size_t> rank(values.size());
  for (std::size_t n = 0; n < order.size(); ++n) rank[order[n]] = n + 1;
  return rank;
}

/// From a to b, of a. What solvers leave of equal values, to about 1e-14 rad or m of 1e-3, is none.
double change_of(double a, double b) {
  constexpr double kRounding = 1e-10;
  const double change = (b - a) / std::abs(a);
  return std::abs(change) < kRounding ? 0.0 : change;
}

std::string_view overlap(const ComparedQuantity& quantity, std::size_t at) {
  if (std::isnan(quantity.a.low[at] + quantity.a.high[at] + quantity.b.low[at] + quantity.b.high[at])) return "-";
  return quantity.a.low[at] <= quantity.b.high[at] && quantity.b.low[at] <= quantity.a.high[at] ? "overlap" : "apart";
}

std::vector<Column> columns(const Comparison& compared) {
  const ComparedQuantity& quantity = compared.quantities.back();
  std::vector<Column> list;
  if (compared.ranked) list = {number_column("rank_a", "rank in A"), number_column("rank_b", "rank in B")};
  for (Column& column :
       std::vector{text_column("item", compared.item_word), number_column("a", "A"), number_column("b", "B"),
                   text_column("unit", "unit"), percent_column("change", "change from A to B")}) {
    list.push_back(std::move(column));
  }
  if (!quantity.a.low.empty()) list.push_back(text_column("intervals", "intervals"));
  return list;
}

/// Of one option.
Table table_of(const Comparison& compared, std::size_t option) {
  const ComparedQuantity& quantity = compared.quantities.back();
  const std::size_t items = compared.items.size();
  const auto ranked = [&](const ComparedValues& values) {
    return ranks(std::span(values.value).subspan(option * items, items));
  };
  const std::vector<std::size_t> rank_a = ranked(compared.quantities.front().a);
  const std::vector<std::size_t> rank_b = ranked(compared.quantities.front().b);
  Table table{.name = fmt::format("differences_{}", option + 1),
              .caption = fmt::format("{}: {}", compared.options[option], quantity.label),
              .columns = columns(compared),
              .rows = std::vector<std::vector<Cell>>(items),
              .notes = {}};
  for (std::size_t p = 0; p < items; ++p) {
    const std::size_t at = option * items + p;
    const double change = change_of(quantity.a.value[at], quantity.b.value[at]);
    std::vector<Cell> row;
    if (compared.ranked) row = {count_cell(rank_a[p]), count_cell(rank_b[p])};
    const std::vector<std::string>& unit = quantity.units[option];
    row.push_back(text_cell(compared.items[p]));
    row.push_back(number_cell(quantity.a.value[at]));
    row.push_back(number_cell(quantity.b.value[at]));
    row.push_back(text_cell(unit.size() == 1 ? unit.front() : unit[p]));
    row.push_back(std::isfinite(change) ? percent_cell(change) : text_cell("-"));
    if (!quantity.a.low.empty()) row.push_back(text_cell(overlap(quantity, at)));
    table.rows[compared.ranked ? rank_a[p] - 1 : p] = std::move(row);
  }
  return table;
}

/// One number for everything, of each option, and how many times larger it is in B.
Table totals_table(const Comparison& compared) {
  Table table{.name = "totals",
              .caption = compared.total_label,
              .columns = {text_column("option", compared.option_word), number_column("a", "A"), number_column("b", "B"),
                          text_column("unit", "unit"), number_column("ratio", "B / A")},
              .rows = {},
              .notes = {}};
  for (std::size_t option = 0; option < compared.options.size(); ++option) {
    const double a = compared.total_a[option];
    const double b = compared.total_b[option];
    table.rows.push_back({text_cell(compared.options[option]), number_cell(a), number_cell(b),
                          text_cell(compared.quantities.front().units[option].front()), number_cell(b / a)});
  }
  return table;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// What the caption of the bars says of their order; quantities whose units differ by item follow the first.
std::string order_of(const Comparison& compared) {
  const auto differ = [](const ComparedQuantity& quantity) {
    return std::ranges::any_of(quantity.units, [](const std::vector<std::string>& units) {
      return std::ranges::adjacent_find(units, std::ranges::not_equal_to()) != units.end();
    });
  };
  if (!compared.ranked) return {};
  return ", " + order_by_effect(std::ranges::any_of(compared.quantities, differ));
}

}  // namespace

void add_comparison(const Comparison& compared, Page& page) {
  ArrayPool& pool = page.figures.pool;
  Section section("differences", "What differs");
  section.paragraph(
      fmt::format("A and B side by side, for each {} that both have. Changes are from A to B, in percent of A.",
                  compared.item_word));
  for (const auto& [letter, only] : {std::pair("A", &compared.only_a), std::pair("B", &compared.only_b)}) {
    if (!only->empty()) section.paragraph(fmt::format("Only in {}: {}.", letter, joined(*only)));
  }
  if (!compared.total_label.empty()) section.table(totals_table(compared));
  add_figure(page, section, "side-by-side", bars_of(compared, pool), "A and B side by side" + order_of(compared) + ".");
  std::vector<Table> tables;
  for (std::size_t option = 0; option < compared.options.size(); ++option) tables.push_back(table_of(compared, option));
  section.table(tables.front());
  tables.erase(tables.begin());
  section.folded(fmt::format("The same for every other {}", compared.option_word), tables);
  page.sections.push_back(std::move(section));
  if (compared.items.size() < 2) return;
  Section agreement("agreement", "Where A and B agree");
  agreement.paragraph(fmt::format("Each point is one {}. On the line A and B are equal.", compared.item_word));
  add_figure(page, agreement, "agreement", scatter_of(compared, pool), "A across, B upwards.");
  page.sections.push_back(std::move(agreement));
}

}  // namespace poesy
