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

/// How values are shown: every table makes its columns and cells here. Settings of a study as people read them.
namespace poesy {

/// Position of a response among the result's; it must have it.
std::size_t response_named(const StoredResult& result, std::string_view name);

std::string count_text(std::uint64_t count);                                            ///< "17 380 000".
std::string counted(std::uint64_t count, std::string_view one, std::string_view many);  ///< "1 pose", "3 poses".
std::string number_text(double value, int digits = 4);  ///< To this many significant digits; "-" for NaN.
/// A share in percent, to three digits; above 90 %, to three digits of what is missing from 100 %: "1.25", "99.73"; "-"
/// for NaN.
std::string percent_number(double share);
std::string percent_text(double share);         ///< The same with its sign, "99.73 %".
std::string unit_text(const NamedUnit& named);  ///< The unit in which people read it, "mm"; empty for a pure number.

std::vector<std::string> names_of(const std::vector<NamedUnit>& things);  ///< The names, in order.

/// The first of these, "a, b, c and 3 more".
std::string some_names(const std::vector<std::string>& names, std::size_t most = 5);

/// Positions in two lists of names that both have, in the order of the first.
using Common = std::vector<std::pair<std::size_t, std::size_t>>;

/// Of the names that both have.
Common common(const std::vector<std::string>& a, const std::vector<std::string>& b);

/// The names that `these` has and `others` has not.
std::vector<std::string> only_in(const std::vector<std::string>& these, const std::vector<std::string>& others);

/// By what mismatch of angle was weighed against mismatch of position: "platform, by displacement of 3 points". Empty
/// where nothing is weighed.
std::string metric_text(const StoredResult& result);

/// A value of a response, SI, in the unit in which people read it, "0.05 mm".
std::string response_text(const NamedUnit& response, double si);

/// Where a pose is, in the units shown: "z -190 mm, beta 20 deg, gamma -30 deg"; on a trajectory with its time before,
/// "t 1.18 s, ...". To three digits. Empty for a number that is no pose of the result.
std::string coordinates_text(const StoredResult& result, std::size_t pose);
std::string place_text(const StoredResult& result, std::size_t pose);  ///< "pose 14 (z -190 mm)".

/// A column of words. dispensable, here and below: as of Column.
Column text_column(std::string name, std::string heading, int dispensable = 0);
/// A column of numbers in one unit, or in none.
Column number_column(std::string name, std::string heading, std::string_view unit = "", int dispensable = 0);
Column percent_column(std::string name, std::string heading, int dispensable = 0);  ///< A column of shares, in percent.

/// A column and its cell in the row of each of some things, by the position of the thing.
struct FilledColumn {
  Column column;                          ///< its heading
  std::function<Cell(std::size_t)> cell;  ///< of the thing at this position
};

/// Gives a table these columns, and a row for each of these positions.
void fill(Table& table, const std::vector<std::size_t>& positions, const std::vector<FilledColumn>& columns);

/// The names of things, under the word for one. Refers to the things, as unit_column does.
FilledColumn name_column(const std::vector<NamedUnit>& things, const std::string& word);
FilledColumn unit_column(const std::vector<NamedUnit>& things);  ///< The units in which people read them.

std::vector<std::size_t> positions(std::size_t count);  ///< 0, 1, ..., count - 1.

Cell text_cell(std::string_view text);           ///< A word; "-" for an empty text.
Cell number_cell(double value, int digits = 4);  ///< A number to this many significant digits.
/// A value, SI, in the unit in which people read the named thing.
Cell value_cell(double si, const NamedUnit& named, int digits = 4);
Cell count_cell(std::uint64_t count);  ///< A whole number with all its digits.
Cell percent_cell(double share);       ///< A share, for a percent_column.
/// An index or an end of its interval, shown as index * scale. Below `rounding` (stats/indices.h) it is shown as 0, or
/// as kTooSmall, without a number, where the error is too small to tell.
Cell index_cell(double index, double scale, double rounding);

inline constexpr std::string_view kTooSmall = "rounding";  ///< Stands for an index that cannot be told from rounding.

/// A value of a study_setting() as people read it: without quotes and braces, quantities in mm and deg.
std::string readable_setting(std::string_view value);

/// The value of a key of a section, as people read it.
std::string readable_setting(std::string_view study_text, std::string_view section, std::string_view key);

}  // namespace poesy
