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

/// CSV files as plain values. They refer to the result that they show.
namespace poesy {

/// A text for each line of a CSV file, written by csv_cell().
struct CsvText {
  std::string heading;                                ///< heading of the column
  std::function<std::string(std::size_t line)> text;  ///< the text of one cell
};

/// A number for each line of a CSV file.
struct CsvColumn {
  std::string heading;                             ///< heading of the column, with its unit; see with_unit()
  std::function<Number(std::size_t line)> number;  ///< the number of one cell, SI or in the heading's unit
};

/// A column for each pose, "pose_0" and so on. Cells are computed on demand, because there may be many poses.
struct CsvPoseColumns {
  std::size_t poses = 0;                                             ///< number of columns
  std::string unit = "1";                                            ///< unit in the headings; see with_unit()
  std::function<Number(std::size_t line, std::size_t pose)> number;  ///< the number of one cell, SI or in that unit
};

/// A CSV file: a first line with the names of the columns, then one line for each thing.
struct CsvTable {
  std::string name;                                ///< name of the file, without ".csv"
  CsvText first;                                   ///< the first cell of a line
  std::size_t lines = 0;                           ///< number of lines, without the first one
  std::vector<CsvColumn> columns = {};             ///< NaN is written as "NaN", a whole number with all its digits
  CsvText last = {};                               ///< a cell after the numbers; none if its heading is empty
  std::function<bool(std::size_t line)> has = {};  ///< whether the file has this line; empty: it has all
  std::vector<CsvText> more = {};                  ///< cells between `first` and the numbers
  std::vector<CsvText> rest = {};                  ///< cells after `last`
  CsvPoseColumns at_poses = {};                    ///< numbers after those of `columns`
};

/// CSV files, in the order in which they are listed.
using CsvTables = std::vector<CsvTable>;

/// A text as a cell of a CSV file (RFC 4180): in quotes if it contains a comma, a semicolon or a quote, which is then
/// doubled. Control characters, including line ends, become "?". A text that begins with = + - or @ gets an apostrophe
/// in front, because spreadsheets take it for a formula even in quotes.
std::string csv_cell(std::string_view text);

/// "name [unit]", or the name alone for a pure number.
std::string with_unit(const std::string& name, const std::string& unit);

/// Writes the table into an existing folder. Returns the path. Throws FileError.
std::string write_csv(const std::string& folder, const CsvTable& table);

/// The SI units of things whose units may differ: "m", or "m or rad".
std::string si_units(const std::vector<NamedUnit>& things);
std::string display_units(const std::vector<NamedUnit>& things);  ///< The units in which people read them: "mm or deg".

/// The unit of a row of fields.h in CSV. response: the response to which its numbers belong, if any.
std::string csv_unit(const std::string& unit, const StoredResult& result, const NamedUnit* response = nullptr);

/// A table with a line for each error of the result.
CsvTable lines_of_factors(const StoredResult& result, std::string name);
CsvTable lines_of_poses(const StoredResult& result, std::string name);  ///< A table with a line for each pose.

/// A column of the elements of a list, or of get(element). Refers to the list.
template <class List, class Get = std::identity>
CsvColumn list_column(std::string heading, const List& list, Get get = {}) {
  return {std::move(heading),
          [elements = std::span(list), get](std::size_t line) { return to_number(std::invoke(get, elements[line])); }};
}

/// A column of the elements of a field, beginning with this one.
template <class Found>
CsvColumn field_column(std::string heading, const FieldRow<Found>& field, const Found& found, std::size_t first = 0) {
  return {std::move(heading),
          [&field, &found, first](std::size_t line) { return number_at(field, found, first + line); }};
}

/// A column of the elements of a field along several axes, at this position on the first one.
template <class Found>
CsvColumn field_row_column(std::string heading, const FieldRow<Found>& field, const Found& found, std::size_t at) {
  return {std::move(heading),
          [&field, &found, at](std::size_t line) { return field.member->number_in_row(found, at, line); }};
}

/// A column for each pose, from an array whose last two axes are those of the lines and the poses. at: positions on the
/// axes before them.
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

/// The same from a field along [response x factor x pose], for one response.
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
