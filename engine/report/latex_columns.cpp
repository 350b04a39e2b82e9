#include "engine/report/latex_columns.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "engine/report/latex_text.h"

namespace poesy {
namespace {

constexpr double kPointsPerMillimetre = 72.27 / 25.4;
/// Width in mm that stays free, because the estimates ignore kerning, which can make words wider.
constexpr double kReserve = 1.0;
/// The least width in points of a column of words that is broken into lines, if neither the heading nor a single word
/// is wider.
constexpr double kLeastParagraph = 60.0;

bool is_interval(const Column& column) { return heading_of(column) == "low" || heading_of(column) == "high"; }

/// Returns true if the column has limits, units, values or ends of intervals. Such columns are left out after all
/// others.
bool is_of_the_answer(const Column& column) {
  constexpr std::array<std::string_view, 3> kHeadings{"limit", "unit", "value"};
  return is_interval(column) || std::ranges::find(kHeadings, heading_of(column)) != kHeadings.end();
}

double cell_width(const Cell& cell, Column::Kind kind) {
  const bool is_number = kind == Column::Kind::number && latex_number(cell.text);
  return is_number ? latex_number_width(cell.text) : latex_width(cell.text);
}

/// The smallest and the largest width of a column, points.
struct Widths {
  double least;    ///< width with the cells broken into lines
  double natural;  ///< width with each cell in one line
};

double widest_word(std::string_view text) {
  double widest = 0.0;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    widest = std::max(widest, latex_width(text.substr(from, end - from)));
    from = end + 1;
  }
  return widest;
}

/// A heading with its unit in LaTeX, and its width in points. It has two lines if in one line it would be wider than
/// the cells and the second line makes it narrower.
struct Heading {
  std::string upper;
  std::string lower;
  double width;
};

Heading heading_in_lines(const Column& column, double cells) {
  const std::string words(heading_of(column));
  const std::string unit = column.unit.empty() ? "" : "[" + latex_unit(column.unit) + "]";
  const double unit_width = column.unit.empty() ? 0.0 : latex_width("[" + column.unit + "]");
  const double blank = column.unit.empty() ? 0.0 : latex_width(" ");
  const auto below = [&](const std::string& text) {
    return latex_text(text) + (text.empty() || unit.empty() ? "" : " ") + unit;
  };
  Heading best{"", below(words), latex_width(words) + blank + unit_width};
  for (std::size_t at = words.find(' '); best.width > cells; at = words.find(' ', at + 1)) {
    const std::string lower = at == std::string::npos ? "" : words.substr(at + 1);
    if (lower.empty() && unit.empty()) break;
    const std::string upper = words.substr(0, at);
    const double lower_width = latex_width(lower) + (lower.empty() ? 0.0 : blank) + unit_width;
    const double width = std::max(latex_width(upper), lower_width);
    if (width < best.width) best = {latex_text(upper), below(lower), width};
    if (at == std::string::npos) break;
  }
  return best;
}

double widest_cell(const Table& table, std::size_t c) {
  double widest = 0.0;
  for (const std::vector<Cell>& row : table.rows) {
    widest = std::max(widest, cell_width(row[c], table.columns[c].kind));
  }
  return widest;
}

Widths widths_of(const Table& table, std::size_t c) {
  const double cells = widest_cell(table, c);
  const double heading = heading_in_lines(table.columns[c], cells).width;
  const double natural = std::max(cells, heading);
  if (table.columns[c].kind == Column::Kind::number) return {natural, natural};
  double word = 0.0;
  for (const std::vector<Cell>& row : table.rows) word = std::max(word, widest_word(row[c].text));
  return {std::max({word, heading, std::min(natural, kLeastParagraph)}), natural};
}

/// The width, in points, that is left for the cells of all columns: `millimetres` without kReserve and without the gaps
/// between columns.
double room_of(const Table& table, double millimetres) {
  return (millimetres - kReserve) * kPointsPerMillimetre - kColumnGap * static_cast<double>(table.columns.size() - 1);
}

bool fits(const Table& table, double millimetres) {
  double width = 0.0;
  for (std::size_t c = 0; c < table.columns.size(); ++c) width += widths_of(table, c).least;
  return width <= room_of(table, millimetres);
}

template <class Keep>
Table with_columns(const Table& table, const Keep& keep) {
  Table made = table;
  for (std::size_t c = table.columns.size(); c-- > 0;) {
    if (keep(c)) continue;
    const auto at = static_cast<std::ptrdiff_t>(c);
    made.columns.erase(made.columns.begin() + at);
    for (std::vector<Cell>& row : made.rows) row.erase(row.begin() + at);
  }
  return made;
}

/// The index of the first column that is of one of these kinds and not dispensable. It always stays in the table: it
/// has the names of the rows, or the most important number.
std::size_t first_of(const Table& table, std::span<const Column::Kind> kinds) {
  const auto at = std::ranges::find_if(table.columns, [&](const Column& column) {
    return column.dispensable == 0 && std::ranges::find(kinds, column.kind) != kinds.end();
  });
  return static_cast<std::size_t>(at - table.columns.begin());
}

bool always_stays(const Table& table, std::size_t c) {
  constexpr std::array kAny{Column::Kind::text, Column::Kind::number};
  constexpr std::array kNumber{Column::Kind::number};
  return c == first_of(table, kAny) || c == first_of(table, kNumber);
}

Table without_empty_columns(const Table& table) {
  return with_columns(table, [&](std::size_t c) {
    return always_stays(table, c) ||
           std::ranges::any_of(table.rows, [c](const std::vector<Cell>& row) { return row[c].text != "-"; });
  });
}

/// The table without units in the headings of intervals, because an interval has the unit of its value.
Table with_short_headings(Table table) {
  for (Column& column : table.columns) {
    if (is_interval(column)) column.unit.clear();
  }
  return table;
}

/// The index of the column with the value to which the interval in column c belongs; c itself if column c has no
/// interval.
std::size_t value_of(const Table& table, std::size_t c) {
  std::size_t value = c;
  while (value > 0 && is_interval(table.columns[value])) --value;
  return value;
}

/// How dispensable a column is in a paper; 0 if step 2 of fitted() does not leave it out. Intervals and units are as
/// dispensable as the number to their left.
int dispensable(const Table& table, std::size_t c) {
  std::size_t number = c;
  while (number > 0 && (is_interval(table.columns[number]) || heading_of(table.columns[number]) == "unit")) --number;
  return is_of_the_answer(table.columns[number]) ? 0 : table.columns[number].dispensable;
}

/// The table without the columns that are most dispensable; none if no column is dispensable.
std::optional<Table> without_a_group(const Table& table) {
  int most = 0;
  for (std::size_t c = 0; c < table.columns.size(); ++c) most = std::max(most, dispensable(table, c));
  if (most == 0) return std::nullopt;
  return with_columns(table, [&](std::size_t c) { return dispensable(table, c) < most; });
}

/// Returns true if column `other` is left out together with column `left_out`: if both are the same column, if `other`
/// is an end of the interval of `left_out`, or if both are the ends of one interval.
bool goes_with(const Table& table, std::size_t other, std::size_t left_out) {
  if (other == left_out) return true;
  if (always_stays(table, other) || !is_interval(table.columns[other])) return false;
  return value_of(table, other) == value_of(table, left_out);
}

/// Returns true for a column of numbers whose units are in a separate column of units: its heading has no unit, or a
/// unit such as "mm/unit" that refers to the separate column.
bool needs_unit(const Column& column) {
  const bool has_own = !column.unit.empty() && column.unit.find("unit") == std::string::npos;
  return column.kind == Column::Kind::number && !has_own && !is_interval(column);
}

/// Returns true for a column of units that no number needs any more. The numbers that may need it are in the columns
/// between the previous and the next column of units.
bool is_orphan_unit(const Table& table, std::size_t c) {
  const auto is_unit = [](const Column& column) { return heading_of(column) == "unit"; };
  if (!is_unit(table.columns[c])) return false;
  const auto here = table.columns.begin() + static_cast<std::ptrdiff_t>(c);
  const auto first = std::find_if(std::make_reverse_iterator(here), table.columns.rend(), is_unit).base();
  const auto last = std::find_if(here + 1, table.columns.end(), is_unit);
  return std::none_of(first, here, needs_unit) && std::none_of(here + 1, last, needs_unit);
}

Table without_orphan_units(const Table& table) {
  return with_columns(table, [&](std::size_t c) { return !is_orphan_unit(table, c); });
}

/// The table without one more column and its interval: the rightmost column for which is_of_the_answer() is false, or
/// the rightmost of all if there is no such column. None if only the columns that always stay are left.
std::optional<Table> without_a_column(const Table& table) {
  for (const bool also_answer : {false, true}) {
    for (std::size_t c = table.columns.size(); c-- > 0;) {
      if (always_stays(table, c) || (!also_answer && is_of_the_answer(table.columns[c]))) continue;
      return without_orphan_units(with_columns(table, [&](std::size_t other) { return !goes_with(table, other, c); }));
    }
  }
  return std::nullopt;
}

/// Makes the widest columns narrower until the columns together are as narrow as `room` (points), but no column
/// narrower than its least width.
void narrow(std::vector<ColumnLayout>& layout, const std::vector<Widths>& widths, double room) {
  const auto total = [&] {
    return std::transform_reduce(layout.begin(), layout.end(), 0.0, std::plus(),
                                 [](const auto& one) { return one.width; });
  };
  while (total() > room) {
    std::optional<std::size_t> widest;
    for (std::size_t c = 0; c < layout.size(); ++c) {
      const bool can_shrink = layout[c].width > widths[c].least;
      if (can_shrink && (!widest || layout[c].width > layout[*widest].width)) widest = c;
    }
    if (!widest) return;
    layout[*widest].width = std::max(layout[*widest].width - 1.0, widths[*widest].least);
    layout[*widest].is_paragraph = true;
  }
}

}  // namespace

std::string_view heading_of(const Column& column) { return column.heading.empty() ? column.name : column.heading; }

std::string latex_cell(const Cell& cell, Column::Kind kind) {
  if (cell.text == "-") return "--";
  if (kind == Column::Kind::text) return latex_text(cell.text);
  if (cell.text == "inf" || cell.text == "-inf") return cell.text.front() == '-' ? "$-\\infty$" : "$\\infty$";
  return latex_number(cell.text).value_or(latex_text(cell.text));
}

Table fitted(const Table& table, double millimetres) {
  if (fits(table, millimetres)) return table;
  Table made = with_short_headings(without_empty_columns(table));
  while (!fits(made, millimetres)) {
    std::optional<Table> less = without_a_group(made);
    if (!less) less = without_a_column(made);
    if (!less) return made;
    made = *std::move(less);
  }
  return made;
}

std::vector<ColumnLayout> layout_of(const Table& table, double millimetres) {
  std::vector<ColumnLayout> layout;
  std::vector<Widths> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    widths.push_back(widths_of(table, c));
    Heading heading = heading_in_lines(table.columns[c], widest_cell(table, c));
    layout.push_back({std::move(heading.upper), std::move(heading.lower), widths.back().natural});
  }
  narrow(layout, widths, room_of(table, millimetres));
  return layout;
}

}  // namespace poesy
