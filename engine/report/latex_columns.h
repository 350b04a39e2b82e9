#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/report/table.h"

/// The columns of a table that fit in a given width in LaTeX, by an estimate of their widths in type of 8 points.
namespace poesy {

inline constexpr double kColumnGap = 6.0;  ///< space between two columns in points

/// How a column is set.
struct ColumnLayout {
  std::string upper;          ///< upper line of the heading in LaTeX; empty if one line is enough
  std::string lower;          ///< last line of the heading in LaTeX, with the unit
  double width;               ///< width in points, an estimate
  bool is_paragraph = false;  ///< true if the cells are broken into lines of this width
};

std::string_view heading_of(const Column& column);  ///< The heading, or the name of a column without heading.

/// A cell in LaTeX.
std::string latex_cell(const Cell& cell, Column::Kind kind);

/// The table with the columns that fit in a width. Columns of words are broken into lines before a column is left out.
/// The columns are left out in this order:
/// 1. columns without any value, and the units in the headings of intervals, which are those of their values;
/// 2. dispensable columns, the most dispensable first, but not limits, units and intervals;
/// 3. the others, the rightmost first, and last limits, units and intervals.
/// The first column and the first number that are not dispensable always stay. An interval goes with its value, and in
/// step 2 a unit with the number to its left.
Table fitted(const Table& table, double millimetres);

/// How the columns of a table are set in a width. If they do not fit, the widths are the smallest.
std::vector<ColumnLayout> layout_of(const Table& table, double millimetres);

}  // namespace poesy
