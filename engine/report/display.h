#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/report/table.h"
#include "engine/result/result_file.h"
#include "engine/schema/settings.h"

/// How values are shown. All tables make their columns and cells with these functions, and settings of a study are
/// converted to text for people.
namespace poesy {

/// The position of a response in the result. Precondition: the result has it.
std::size_t response_named(const StoredResult& result, std::string_view name);

std::string count_text(std::uint64_t count);  ///< "17 380 000".
std::string counted(std::uint64_t count, std::string_view one,
                    std::string_view many);             ///< A number with a noun: "1 pose", "3 poses".
std::string number_text(double value, int digits = 4);  ///< A number to this many significant digits; "-" for NaN.
/// A share in percent, to three digits; above 90 %, to three digits of its difference from 100 %: "1.25", "99.73"; "-"
/// for NaN.
std::string percent_number(double share);
std::string percent_text(double share);         ///< The same with a percent sign, "99.73 %".
std::string unit_text(const NamedUnit& named);  ///< The unit that people read, "mm"; empty for a pure number.

std::vector<std::string> names_of(const std::vector<NamedUnit>& things);  ///< The names of the things, in order.

/// A list of names that is cut after `most`: "a, b, c and 3 more".
std::string some_names(const std::vector<std::string>& names, std::size_t most = 5);

/// Pairs of positions of names that two lists have in common, in the order of the first.
using Common = std::vector<std::pair<std::size_t, std::size_t>>;

/// The names that both lists have in common.
Common common(const std::vector<std::string>& a, const std::vector<std::string>& b);

/// The names in `these` that are not in `others`.
std::vector<std::string> only_in(const std::vector<std::string>& these, const std::vector<std::string>& others);

/// The metric that weighs angles against lengths: "platform, by displacement of 3 points". Empty if there is none.
std::string metric_text(const StoredResult& result);

/// A value of a response, SI, as text in the unit that people read: "0.05 mm".
std::string response_text(const NamedUnit& response, double si);

/// The coordinates of a pose in the units shown, to three digits: "z -190 mm, beta 20 deg, gamma -30 deg"; on a
/// trajectory the time comes first, "t 1.18 s, ...". Empty for a pose that the result does not have.
std::string coordinates_text(const StoredResult& result, std::size_t pose);
std::string place_text(const StoredResult& result,
                       std::size_t pose);  ///< A pose with its coordinates: "pose 14 (z -190 mm)".

/// A column of words. dispensable, here and below: see Column::dispensable.
Column text_column(std::string name, std::string heading, int dispensable = 0);
/// A column of numbers with one unit, or without.
Column number_column(std::string name, std::string heading, std::string_view unit = "", int dispensable = 0);
Column percent_column(std::string name, std::string heading, int dispensable = 0);  ///< A column of shares, in percent.

/// A column with its cells, which are computed from the position of a thing.
struct FilledColumn {
  Column column;                          ///< the column
  std::function<Cell(std::size_t)> cell;  ///< the cell of the thing at this position
};

/// Adds these columns to a table, and a row for each of these positions.
void fill(Table& table, const std::vector<std::size_t>& positions, const std::vector<FilledColumn>& columns);

/// A column of the names of things. word: its heading. Refers to the things, as unit_column() does.
FilledColumn name_column(const std::vector<NamedUnit>& things, const std::string& word);
FilledColumn unit_column(const std::vector<NamedUnit>& things);  ///< A column of the units that people read.

std::vector<std::size_t> positions(std::size_t count);  ///< The positions 0, 1, ..., count - 1.

Cell text_cell(std::string_view text);           ///< A word; "-" for an empty text.
Cell number_cell(double value, int digits = 4);  ///< A number to this many significant digits.
/// A value, SI, in the unit that people read for the named thing.
Cell value_cell(double si, const NamedUnit& named, int digits = 4);
Cell count_cell(std::uint64_t count);  ///< A whole number with all its digits.
Cell percent_cell(double share);       ///< A share for a percent_column().
/// An index, or an end of its interval, shown as index * scale. Below `rounding` (stats/indices.h) it is shown as 0, or
/// as kTooSmall without a number if the error is too small to tell.
Cell index_cell(double index, double scale, double rounding);

inline constexpr std::string_view kTooSmall =
    "rounding";  ///< The text for an index that cannot be distinguished from rounding.

/// A value of a study_setting() for people: without quotes and braces, quantities in mm and deg.
std::string readable_setting(std::string_view value);

/// The value of a key of a section, for people.
std::string readable_setting(std::string_view study_text, std::string_view section, std::string_view key);

}  // namespace poesy
