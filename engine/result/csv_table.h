#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/number.h"
#include "engine/result/fields.h"
#include "engine/result/result_file.h"

/// CSV tables of a result. A table refers to the result, which must outlive it.
namespace poesy {

/// A column of texts of a CSV file. Each text is written as csv_cell().
struct CsvText {
  std::string heading;                                ///< heading of the column
  std::function<std::string(std::size_t line)> text;  ///< text in this line; lines count from 0
};

/// A column of numbers of a CSV file.
struct CsvColumn {
  std::string heading;                             ///< heading of the column with its unit; see with_unit()
  std::function<Number(std::size_t line)> number;  ///< value in this line: SI, or in the unit that the heading states
};

/// A column of numbers for each pose, named "pose_0" and so on. Cells are computed on demand, because there may be many
/// poses.
struct CsvPoseColumns {
  std::size_t poses = 0;   ///< number of columns
  std::string unit = "1";  ///< unit of the numbers, for the headings; see with_unit()
  /// The value in this line at this pose, in `unit`. Lines and poses count from 0.
  std::function<Number(std::size_t line, std::size_t pose)> number;
};

/// A CSV file: a first line with the headings of the columns, then one line for each thing, such as an error or a pose.
struct CsvTable {
  std::string name;       ///< name of the file, without ".csv"
  CsvText first;          ///< column before all others, such as the names of errors or the numbers of poses
  std::size_t lines = 0;  ///< number of lines below the headings
  /// Columns of numbers; NaN is written as "NaN", a whole number with all its digits.
  std::vector<CsvColumn> columns = {};
  CsvText last = {};  ///< column of texts after the numbers; none if its heading is empty
  /// Returns true if the line is written. An empty function: all lines are written.
  std::function<bool(std::size_t line)> has = {};
  std::vector<CsvText> more = {};  ///< columns of texts between `first` and the numbers
  std::vector<CsvText> rest = {};  ///< columns of texts after `last`
  CsvPoseColumns at_poses = {};    ///< columns of numbers after those of `columns`
};

/// The CSV tables of a result, in the order in which `poesy export` lists them.
using CsvTables = std::vector<CsvTable>;

/// A text as a cell of a CSV file (RFC 4180). A text with a comma, a semicolon or a quote is put in quotes, and its
/// quotes are doubled. Control characters, including line ends, become "?". A text that begins with = + - or @ and is
/// not a number gets an apostrophe in front, because spreadsheets would read it as a formula, even in quotes.
std::string csv_cell(std::string_view text);

/// A heading "name [unit]", or the name alone for a number without unit.
std::string with_unit(const std::string& name, const std::string& unit);

/// Writes a table as a CSV file into an existing folder, and returns the path of the file. Throws FileError.
std::string write_csv(const std::string& folder, const CsvTable& table);

/// The SI units of things, joined by "or" if they differ: "m", or "m or rad".
std::string si_units(const std::vector<NamedUnit>& things);
/// The units in which reports show these things, joined by "or": "mm or deg".
std::string display_units(const std::vector<NamedUnit>& things);

/// The unit in a CSV heading for the numbers of a dataset. unit: unit of the dataset, which may be one of the texts in
/// fields.h, such as kResponseUnit. response: the response to which the numbers belong; null if they belong to none.
std::string csv_unit(const std::string& unit, const StoredResult& result, const NamedUnit* response = nullptr);

/// A table with a line for each error of the result, and no columns of numbers yet.
CsvTable lines_of_factors(const StoredResult& result, std::string name);
/// A table with a line for each pose, and no columns of numbers yet.
CsvTable lines_of_poses(const StoredResult& result, std::string name);

/// A column with get(element) for each element of a list; by default the elements themselves. The column keeps a
/// reference to the list.
template <class List, class Get = std::identity>
CsvColumn list_column(std::string heading, const List& list, Get get = {}) {
  return {std::move(heading),
          [elements = std::span(list), get](std::size_t line) { return to_number(std::invoke(get, elements[line])); }};
}

/// A column of consecutive elements of a field, row-major. first: index of the element in the first line.
template <class Found>
CsvColumn field_column(std::string heading, const FieldRow<Found>& field, const Found& found, std::size_t first = 0) {
  return {std::move(heading),
          [&field, &found, first](std::size_t line) { return number_at(field, found, first + line); }};
}

/// A column of those elements of a field that have the index `at` on its first axis.
template <class Found>
CsvColumn field_row_column(std::string heading, const FieldRow<Found>& field, const Found& found, std::size_t at) {
  return {std::move(heading),
          [&field, &found, at](std::size_t line) { return field.member->number_in_row(found, at, line); }};
}

/// A column for each pose, from an array whose last two axes belong to the lines and to the poses. at: indices on the
/// axes before these two.
template <class T, NamedAxis... Axes, std::integral... Positions>
CsvPoseColumns pose_columns(const Array<T, Axes...>& array, std::string unit, Positions... at) {
  return {array.template length<axis::Pose>(), std::move(unit),
          [&array, at...](std::size_t line, std::size_t pose) { return to_number(array(at..., line, pose)); }};
}

/// A table with a line for each error and a column for each pose, from a field along [factor x pose].
template <class Found>
CsvTable cell_table(const StoredResult& result, std::string name, const FieldRow<Found>& field, const Found& found) {
  CsvTable table = lines_of_factors(result, std::move(name));
  table.at_poses = {
      result.poses.size(), csv_unit(field.unit, result),
      [&field, &found](std::size_t line, std::size_t pose) { return field.member->number_in_row(found, line, pose); }};
  return table;
}

/// A table with a line for each error and a column for each pose, for one response of a field along [response x factor
/// x pose].
template <class Found>
CsvTable response_table(const StoredResult& result, std::size_t response, const FieldRow<Found>& field,
                        const Found& found) {
  const NamedUnit& named = result.responses[response];
  const std::size_t poses = result.poses.size();
  CsvTable table = lines_of_factors(result, field.name + "_" + named.name);
  table.at_poses = {poses, csv_unit(field.unit, result, &named),
                    [&field, &found, response, poses](std::size_t line, std::size_t pose) {
                      return field.member->number_in_row(found, response, line * poses + pose);
                    }};
  return table;
}

}  // namespace poesy
