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

/// Functions that make texts, table columns and table cells for people from the values of a result, and readable texts
/// from the settings of a study.
namespace poesy {

/// The index of the response with this name in StoredResult::responses. Precondition: the result has the response.
std::size_t response_named(const StoredResult& result, std::string_view name);

std::string count_text(std::uint64_t count);  ///< A whole number with its digits in groups of three: "17 380 000".
/// A number with a noun: "1 pose", "3 poses".
std::string counted(std::uint64_t count, std::string_view one, std::string_view many);
std::string number_text(double value, int digits = 4);  ///< A number to this many significant digits; "-" for NaN.
/// A share (0 to 1) in percent, without the sign "%": "1.25", "99.73"; "-" for NaN. Up to 90 %, three significant
/// digits are shown. Above 90 %, so many decimals are shown that the difference from 100 % has three significant
/// digits. Trailing zeros are left out.
std::string percent_number(double share);
/// A share in percent as percent_number() gives it, with the sign: "99.73 %"; "-" for NaN.
std::string percent_text(double share);
/// The unit in which results show a quantity, such as "mm"; empty if the quantity has no unit.
std::string unit_text(const NamedUnit& named);

std::vector<std::string> names_of(const std::vector<NamedUnit>& things);  ///< The names of these quantities.

/// A list of names that is cut after `most` names: "a, b, c and 3 more".
std::string some_names(const std::vector<std::string>& names, std::size_t most = 5);

/// For each name that two lists have in common: its index in the first list, and its index in the second list.
/// The pairs are in the order of the first list.
using Common = std::vector<std::pair<std::size_t, std::size_t>>;

/// Finds the names that are in both lists.
Common common(const std::vector<std::string>& a, const std::vector<std::string>& b);

/// The names in `these` that are not in `others`.
std::vector<std::string> only_in(const std::vector<std::string>& these, const std::vector<std::string>& others);

/// The metric that weighs angles against lengths, in words: "platform, by displacement of 3 points". Empty if the
/// result has no metric.
std::string metric_text(const StoredResult& result);
/// The decision on the wanted yield: "PASS", "FAIL" or "UNDECIDED". "PASS for these measured parts" if the parts on
/// which errors were measured do not show the yield (YieldVerdict::parts_leave_open()). Empty if the study asks for no
/// yield.
std::string verdict_words(const YieldVerdict& yield);

/// A value of a response (SI) as text in the unit that results show: "0.05 mm".
std::string response_text(const NamedUnit& response, double si);

/// The coordinates of a pose in the units that results show, to three significant digits, or to whole units from 1000
/// on: "z -190 mm, beta 20 deg, gamma -30 deg". On a trajectory the time comes first: "t 1.18 s, ...". Empty if the
/// result has no pose with this index.
std::string coordinates_text(const StoredResult& result, std::size_t pose);
/// A pose with its coordinates: "pose 14 (z -190 mm)".
std::string place_text(const StoredResult& result, std::size_t pose);

/// A column of words. dispensable: see Column::dispensable; the functions below have the same parameter.
Column text_column(std::string name, std::string heading, int dispensable = 0);
/// A column of numbers. unit: unit of all numbers; empty if the numbers have no unit, or have different units.
Column number_column(std::string name, std::string heading, std::string_view unit = "", int dispensable = 0);
Column percent_column(std::string name, std::string heading, int dispensable = 0);  ///< A column of shares, in percent.
Column main_column(Column column);  ///< The same column, which a narrow page never hides (Column::main).

/// A column and a function that makes its cells.
struct FilledColumn {
  Column column;                          ///< heading, unit and kind of the column
  std::function<Cell(std::size_t)> cell;  ///< makes the cell for the thing with this index
};

/// Adds these columns to a table, and a row for each index in `positions`. The columns' functions make the row's cells.
void fill(Table& table, const std::vector<std::size_t>& positions, const std::vector<FilledColumn>& columns);

/// A column with the names of these quantities. word: heading of the column. `things` must outlive the returned column.
FilledColumn name_column(const std::vector<NamedUnit>& things, const std::string& word);
/// A column with the units in which results show these quantities. `things` must outlive the returned column.
FilledColumn unit_column(const std::vector<NamedUnit>& things);

std::vector<std::size_t> positions(std::size_t count);  ///< The indices 0, 1, ..., count - 1.

Cell text_cell(std::string_view text);           ///< A cell with a word; "-" for an empty text.
Cell number_cell(double value, int digits = 4);  ///< A cell with a number to this many significant digits.
/// A cell with a value (SI) of the named quantity, in the unit that results show.
Cell value_cell(double si, const NamedUnit& named, int digits = 4);
Cell count_cell(std::uint64_t count);  ///< A cell with a whole number, with all its digits.
Cell percent_cell(double share);       ///< A cell with a share, for a percent_column().
/// A cell with a sensitivity index, or with an end of its interval. index: value in SI. scale: factor that converts the
/// index to the number shown. rounding: magnitude (SI) below which an index is only rounding error of the solver
/// (index_rounding()) and is shown as 0. If the error is so small that rounding error would also hide an index that
/// matters (is_too_small_to_tell()), the cell has the text kTooSmall and no number.
Cell index_cell(double index, double scale, double rounding);

/// The text of an index_cell() if the index cannot be told from rounding error.
inline constexpr std::string_view kTooSmall = "rounding";

/// Makes a text for people from the value of a setting as study_setting() gives it: without quotes and braces, with
/// quantities in mm and deg.
std::string readable_setting(std::string_view value);

/// Returns true if all samples of the result were solved to first order in the errors. All responses are then linear in
/// the errors, or norms of linear functions, so the result cannot show whether the mechanism is linear.
bool is_first_order(const StoredResult& result);

/// The words with which tables and texts mark a result whose samples were all solved to first order.
inline constexpr std::string_view kFirstOrder = "solved to first order in the errors";

/// The full names ("section.key") and readable values of the settings of a study. Keys outside all sections, such as
/// the title, are left out. study_text: the study file (TOML) with all defaults filled in.
std::vector<std::pair<std::string, std::string>> readable_settings(std::string_view study_text);

/// The value of a key in a section of a study, as a text for people; empty if the study has no such key. study_text:
/// see readable_settings().
std::string readable_setting(std::string_view study_text, std::string_view section, std::string_view key);

}  // namespace poesy
