#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/result_file.h"
#include "engine/report/table.h"

/// How values are shown: every table makes its columns and cells here.
namespace poesy {

/// Position of a response among the result's; it must have it.
std::size_t response_named(const StoredResult& result, std::string_view name);

/// "17 380 000".
std::string count_text(std::uint64_t count);
/// "1 pose", "3 poses".
std::string counted(std::uint64_t count, std::string_view one, std::string_view many);
/// To this many significant digits; "-" for NaN.
std::string number_text(double value, int digits = 4);
/// A share in percent, to three digits; above 90 %, to three digits of what is missing from 100 %: "1.25", "99.73"; "-"
/// for NaN.
std::string percent_number(double share);
/// The same with its sign, "99.73 %".
std::string percent_text(double share);
/// The unit in which people read it, "mm"; empty for a pure number.
std::string unit_text(const NamedUnit& named);

/// The names, in order.
std::vector<std::string> names_of(const std::vector<NamedUnit>& things);

/// The first of these, "a, b, c and 3 more".
std::string some_names(const std::vector<std::string>& names, std::size_t most = 5);

/// By what mismatch of angle was weighed against mismatch of position: "platform, by displacement of 3 points". Empty
/// where nothing is weighed, and for results of older versions.
std::string metric_text(const StoredResult& result);

/// Where a pose is, in the units shown: "z -190 mm, beta 20 deg, gamma -30 deg"; on a trajectory with its time before,
/// "t 1.18 s, ...". To three digits. Empty for a number that is no pose of the result.
std::string coordinates_text(const StoredResult& result, std::size_t pose);
/// "pose 14 (z -190 mm)".
std::string place_text(const StoredResult& result, std::size_t pose);

/// A column of words. dispensable, here and below: as of Column.
Column text_column(std::string name, std::string heading, int dispensable = 0);
/// A column of numbers in one unit, or in none.
Column number_column(std::string name, std::string heading, std::string_view unit = "", int dispensable = 0);
/// A column of shares, in percent.
Column percent_column(std::string name, std::string heading, int dispensable = 0);

/// A word; "-" for an empty text.
Cell text_cell(std::string_view text);
/// A number to this many significant digits.
Cell number_cell(double value, int digits = 4);
/// A whole number with all its digits.
Cell count_cell(std::uint64_t count);
/// A share, for a percent_column.
Cell percent_cell(double share);
/// An index or an end of its interval, shown as index * scale. Below `rounding` (stats/rounding.h) it is shown as 0, or
/// as kTooSmall, without a number, where the error is too small to tell.
Cell index_cell(double index, double scale, double rounding);

/// Stands for an index that cannot be told from rounding.
inline constexpr std::string_view kTooSmall = "rounding";

}  // namespace poesy
