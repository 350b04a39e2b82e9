#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/report/table.h"

/// Chooses the columns of a table that fit into a given width in LaTeX. The widths are estimates for type of 8 points.
namespace poesy {

inline constexpr double kColumnGap = 6.0;  ///< space between two columns in points

/// How LaTeX sets a column.
struct ColumnLayout {
  std::string upper;          ///< upper line of the heading in LaTeX; empty if one line is enough
  std::string lower;          ///< last line of the heading in LaTeX, with the unit
  double width;               ///< width in points, an estimate
  bool is_paragraph = false;  ///< true if the cells are broken into lines of `width`
};

std::string_view heading_of(const Column& column);  ///< The heading, or the name of a column without heading.

/// A cell in LaTeX.
std::string latex_cell(const Cell& cell, Column::Kind kind);

/// The table with the columns that fit into a width, mm. Columns of words are broken into lines before a column is left
/// out. The columns are left out in this order:
/// 1. columns without any value; at the same time, the headings of intervals lose their units, because an interval has
///    the unit of its value;
/// 2. dispensable columns, the most dispensable first, except limits and values;
/// 3. the other columns, the rightmost first, but limits, values, units and intervals after all others.
/// The first column and the first number that are not dispensable always stay. An interval is left out with its value,
/// in step 2 a unit with the number to its left, and in step 3 a unit with the last number that needs it.
Table fitted(const Table& table, double millimetres);

/// How LaTeX sets the columns of a table in a width, mm. If the columns do not fit, each has its smallest width.
std::vector<ColumnLayout> layout_of(const Table& table, double millimetres);

}  // namespace poesy
