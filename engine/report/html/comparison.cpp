#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/report/display.h"
#include "engine/report/report_kind.h"

namespace poesy {
namespace {

[[noreturn]] void refuse(const ReportedResult& b, const ReportedResult& a, std::string_view what) {
  throw InputError({.file = b.path}, fmt::format("has no {} in common with {}", what, a.path),
                   "compare two results that share some");
}

/// The indices of the options or items of a Comparable that are kept, in their new order.
using Kept = std::vector<std::size_t>;

template <class Value>
std::vector<Value> picked(const std::vector<Value>& values, const Kept& kept) {
  std::vector<Value> list;
  for (const std::size_t position : kept) list.push_back(values[position]);
  return list;
}

/// A copy of `from` with only those options and items that are kept, in their new order.
Comparable kept_part(const Comparable& from, const Kept& options, const Kept& items) {
  Comparable part = from;
  part.options = picked(from.options, options);
  part.items = picked(from.items, items);
  if (!from.totals.empty()) part.totals = picked(from.totals, options);
  Kept cells;  // indices of the kept elements in an array [options x items] of `from`
  for (const std::size_t option : options) {
    for (const std::size_t item : items) cells.push_back(option * from.items.size() + item);
  }
  for (ComparableQuantity& quantity : part.quantities) {
    quantity.units = picked(quantity.units, options);
    for (std::vector<std::string>& units : quantity.units) {
      if (units.size() > 1) units = picked(units, items);
    }
    for (std::vector<double>* values : {&quantity.value, &quantity.low, &quantity.high}) {
      if (!values->empty()) *values = picked(*values, cells);
    }
  }
  return part;
}

/// The indices of the common names in the first list if `first` is true, otherwise in the second list.
Kept positions_in(const Common& both, bool first) {
  Kept kept;
  for (const auto& [of_a, of_b] : both) kept.push_back(first ? of_a : of_b);
  return kept;
}

/// The values of result A, followed by those of result B.
std::vector<double> both(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> all = a;
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

Bars bars_of(const Comparison& compared, ArrayPool& pool) {
  const Comparable& a = compared.a;
  Bars bars{{{a.option_word, a.options}}, {}, a.items, {"A", "B"}, a.ranked};
  for (std::size_t n = 0; n < a.quantities.size(); ++n) {
    const ComparableQuantity& in_a = a.quantities[n];
    const ComparableQuantity& in_b = compared.b.quantities[n];
    BarQuantity shown{in_a.label, in_a.units, pool.add(in_a.array, both(in_a.value, in_b.value))};
    if (!in_a.low.empty()) {
      shown.low = pool.add(in_a.array + "_low", both(in_a.low, in_b.low));
      shown.high = pool.add(in_a.array + "_high", both(in_a.high, in_b.high));
    }
    bars.quantities.push_back(std::move(shown));
  }
  return bars;
}

/// A scatter plot of the first quantity: its values in result A (horizontal) and in result B (vertical). Precondition:
/// for each option the quantity has the same unit for all items.
Scatter scatter_of(const Comparison& compared, ArrayPool& pool) {
  const ComparableQuantity& a = compared.a.quantities.front();
  Scatter scatter{{{compared.a.option_word, compared.a.options}},
                  {"A", pool.add(a.array + "_a", a.value)},
                  {"B", pool.add(a.array + "_b", compared.b.quantities.front().value)},
                  {},
                  compared.a.items};
  for (const std::vector<std::string>& unit : a.units) scatter.units.push_back(unit.front());
  return scatter;
}

/// The ranks of an option's items by the magnitudes of their values, from 1 for the largest. Items with unknown values
/// come last. values: [items].
std::vector<std::size_t> ranks(std::span<const double> values) {
  std::vector<std::size_t> order = positions(values.size());
  const auto key = [&](std::size_t p) { return std::isnan(values[p]) ? -HUGE_VAL : std::abs(values[p]); };
  std::ranges::stable_sort(order, std::ranges::greater(), key);
  std::vector<std::size_t> rank(values.size());
  for (std::size_t n = 0; n < order.size(); ++n) rank[order[n]] = n + 1;
  return rank;
}

/// The relative change from a to b. A change below 1e-10 is returned as zero, because it may be rounding error of the
/// solver (about 1e-14 rad or m in values of about 1e-3 rad or m).
double change_of(double a, double b) {
  constexpr double kRounding = 1e-10;
  const double change = (b - a) / std::abs(a);
  return std::abs(change) < kRounding ? 0.0 : change;
}

std::string_view overlap(const ComparableQuantity& a, const ComparableQuantity& b, std::size_t at) {
  if (std::isnan(a.low[at] + a.high[at] + b.low[at] + b.high[at])) return "-";
  return a.low[at] <= b.high[at] && b.low[at] <= a.high[at] ? "overlap" : "apart";
}

/// The table of one option, for instance a response, with the values of the first quantity in A and B.
Table table_of(const Comparison& compared, std::size_t option) {
  const Comparable& all = compared.a;
  const ComparableQuantity& a = all.quantities.front();
  const ComparableQuantity& b = compared.b.quantities.front();
  const std::vector<std::string>& unit = a.units[option];
  const std::size_t items = all.items.size();
  const std::size_t first = option * items;
  const auto ranks_in = [&](const Comparable& result) {
    return ranks(std::span(result.quantities.front().value).subspan(first, items));
  };
  const std::vector<std::size_t> rank_a = ranks_in(all);
  const std::vector<std::size_t> rank_b = ranks_in(compared.b);
  std::vector<std::size_t> order = positions(items);
  std::vector<FilledColumn> columns;
  if (all.ranked) {
    std::ranges::sort(order, {}, [&](std::size_t p) { return rank_a[p]; });
    columns = {{number_column("rank_a", "rank in A", "", 1), [&](std::size_t p) { return count_cell(rank_a[p]); }},
               {number_column("rank_b", "rank in B", "", 1), [&](std::size_t p) { return count_cell(rank_b[p]); }}};
  }
  columns.push_back({text_column("item", all.item_word), [&](std::size_t p) { return text_cell(all.items[p]); }});
  columns.push_back({number_column("a", "A"), [&](std::size_t p) { return number_cell(a.value[first + p]); }});
  columns.push_back({number_column("b", "B"), [&](std::size_t p) { return number_cell(b.value[first + p]); }});
  columns.push_back(
      {text_column("unit", "unit"), [&](std::size_t p) { return text_cell(unit.size() == 1 ? unit[0] : unit[p]); }});
  columns.push_back({percent_column("change", "change from A to B"), [&](std::size_t p) {
                       const double change = change_of(a.value[first + p], b.value[first + p]);
                       return std::isfinite(change) ? percent_cell(change) : text_cell("-");
                     }});
  if (!a.low.empty()) {
    columns.push_back(
        {text_column("intervals", "intervals"), [&](std::size_t p) { return text_cell(overlap(a, b, first + p)); }});
  }
  Table table{.name = fmt::format("differences_{}", option + 1),
              .caption = fmt::format("{}: {}", all.options[option], a.label),
              .columns = {}};
  fill(table, order, columns);
  return table;
}

/// The table with each option's total in the results A and B, and the ratio of B to A.
Table totals_table(const Comparison& compared) {
  const Comparable& a = compared.a;
  Table table{.name = "totals",
              .caption = a.total_label,
              .columns = {text_column("option", a.option_word), number_column("a", "A"), number_column("b", "B"),
                          text_column("unit", "unit"), number_column("ratio", "B / A")}};
  for (std::size_t option = 0; option < a.options.size(); ++option) {
    const double in_a = a.totals[option];
    const double in_b = compared.b.totals[option];
    table.rows.push_back({text_cell(a.options[option]), number_cell(in_a), number_cell(in_b),
                          text_cell(a.quantities.front().units[option].front()), number_cell(in_b / in_a)});
  }
  return table;
}

/// The clause of a caption that describes the order of bars. If the items of some quantity have different units, the
/// clause also warns that their values cannot be compared. Empty if items are not ranked.
std::string order_of(const Comparable& a) {
  const auto differ = [](const ComparableQuantity& quantity) {
    return std::ranges::any_of(quantity.units, [](const std::vector<std::string>& units) {
      return std::ranges::adjacent_find(units, std::ranges::not_equal_to()) != units.end();
    });
  };
  return a.ranked ? ", " + order_by_effect(std::ranges::any_of(a.quantities, differ)) : std::string();
}

}  // namespace

Comparable comparable_by_response(const StoredResult& result, std::string item_word, std::vector<std::string> items) {
  return {"response", names_of(result.responses, response_order(result)), std::move(item_word), std::move(items)};
}

void add_quantity(Comparable& to, const StoredResult& result, std::string label, std::string array,
                  const std::function<double(std::size_t, std::size_t)>& value) {
  const std::vector<std::size_t> responses = response_order(result);
  ComparableQuantity quantity{std::move(label), std::move(array), response_units(result, responses), {}};
  for (const std::size_t r : responses) {
    for (std::size_t item = 0; item < to.items.size(); ++item) {
      quantity.value.push_back(value(r, item) / display(result.responses[r]).si);
    }
  }
  to.quantities.push_back(std::move(quantity));
}

Comparison comparison(const ReportKind& kind, const ReportedResult& a, const ReportedResult& b) {
  const Comparable all_a = kind.comparable(a.stored, b.stored);
  const Comparable all_b = kind.comparable(b.stored, a.stored);
  if (all_a.item_word != all_b.item_word) refuse(b, a, "case");
  const Common options = common(all_a.options, all_b.options);
  if (options.empty()) refuse(b, a, all_a.option_word);
  const Common items = common(all_a.items, all_b.items);
  if (items.empty()) refuse(b, a, all_a.item_word);
  return {kept_part(all_a, positions_in(options, true), positions_in(items, true)),
          kept_part(all_b, positions_in(options, false), positions_in(items, false)), only_in(all_a.items, all_b.items),
          only_in(all_b.items, all_a.items)};
}

std::vector<Table> comparison_tables(const Comparison& compared) {
  std::vector<Table> tables;
  for (std::size_t option = 0; option < compared.a.options.size(); ++option) {
    tables.push_back(table_of(compared, option));
  }
  return tables;
}

Answer comparison_answer(const Comparison& compared) {
  const Comparable& a = compared.a;
  const ComparableQuantity& in_a = a.quantities.front();
  const ComparableQuantity& in_b = compared.b.quantities.front();
  const std::size_t items = a.items.size();
  const auto first = [&](const ComparableQuantity& of) { return std::span(of.value).first(items); };
  std::size_t most = 0;  // index of the item with the largest change
  for (std::size_t p = 0; p < items; ++p) {
    const auto change = [&](std::size_t n) { return std::abs(in_b.value[n] - in_a.value[n]); };
    if (change(p) > change(most) || std::isnan(change(most))) most = p;
  }
  const auto value = [&](const ComparableQuantity& of, std::size_t p) {
    const std::vector<std::string>& unit = of.units.front();
    const std::string& shown = unit.size() == 1 ? unit.front() : unit[p];
    return number_text(of.value[p]) + (shown.empty() ? "" : " " + shown);
  };
  Answer lines;
  if (a.ranked) {
    const auto largest = [&](const ComparableQuantity& of) {
      const std::vector<std::size_t> rank = ranks(first(of));
      return static_cast<std::size_t>(std::ranges::find(rank, 1U) - rank.begin());
    };
    const std::size_t top_a = largest(in_a);
    const std::size_t top_b = largest(in_b);
    lines.emplace_back(
        "Answer", fmt::format("{}, {}: the largest is that of {} in A ({}) and of {} in B ({}).", a.options.front(),
                              in_a.label, a.items[top_a], value(in_a, top_a), a.items[top_b], value(in_b, top_b)));
  }
  if (in_a.value[most] == in_b.value[most] || change_of(in_a.value[most], in_b.value[most]) == 0.0) {
    const auto is_unknown = [](double one) { return std::isnan(one); };
    const bool some_unknown =
        std::ranges::any_of(first(in_a), is_unknown) || std::ranges::any_of(first(in_b), is_unknown);
    lines.emplace_back(a.ranked ? "No change" : "Answer", fmt::format("{}{}, {}: A and B have the same {}values.",
                                                                      a.ranked ? "" : "No change: ", a.options.front(),
                                                                      in_a.label, some_unknown ? "known " : ""));
  } else {
    lines.emplace_back(a.ranked ? "Largest change" : "Answer",
                       fmt::format("{}{}: {}, {}, from {} to {}.", a.ranked ? "" : "Largest change of ",
                                   a.options.front(), a.items[most], in_a.label, value(in_a, most), value(in_b, most)));
  }
  if (!in_a.low.empty() && !in_b.low.empty()) {
    std::size_t apart = 0;
    for (std::size_t p = 0; p < items; ++p) apart += overlap(in_a, in_b, p) == "apart" ? 1 : 0;
    lines.emplace_back("How sure", fmt::format("The intervals of {} of {} are apart, so samples alone do not explain "
                                               "what differs there; where intervals overlap, they may.",
                                               apart, counted(items, a.item_word, a.item_word + "s")));
  }
  lines.emplace_back(
      kWhatToDo,
      "Look first at the settings that differ: they explain the other differences, as far as chance does not.");
  return lines;
}

void add_comparison(const Comparison& compared, Page& page) {
  const Comparable& a = compared.a;
  ArrayPool& pool = page.figures.pool;
  Section& section = page.add_section("differences", "What differs");
  section.paragraph(fmt::format(
      "A and B side by side, for each {} that both have. Changes are from A to B, in percent of A.", a.item_word));
  for (const auto& [letter, only] : {std::pair("A", &compared.only_a), std::pair("B", &compared.only_b)}) {
    if (!only->empty()) section.paragraph(fmt::format("Only in {}: {}.", letter, fmt::join(*only, ", ")));
  }
  if (!a.totals.empty() && !compared.b.totals.empty()) section.table(totals_table(compared));
  add_figure(page, section, "side-by-side", bars_of(compared, pool), "A and B side by side" + order_of(a) + ".");
  const std::vector<Table> tables = comparison_tables(compared);
  section.table(tables.front());
  section.folded(fmt::format("The same for every other {}", a.option_word), std::span(tables).subspan(1));
  if (a.items.size() < 2) return;
  Section& agreement = page.add_section("agreement", "Where A and B agree");
  agreement.paragraph(fmt::format("Each point is one {}. On the line A and B are equal.", a.item_word));
  add_figure(page, agreement, "agreement", scatter_of(compared, pool), "A across, B upwards.");
}

}  // namespace poesy
