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

/// A text for each line of a CSV file; written as csv_cell() says.
struct CsvText {
  std::string heading;                                ///< of the column
  std::function<std::string(std::size_t line)> text;  ///< of one cell
};

/// A number for each line of a CSV file.
struct CsvColumn {
  std::string heading;                             ///< with its unit, see with_unit()
  std::function<Number(std::size_t line)> number;  ///< SI, or in the heading's unit
};

/// A column for each pose, "pose_0" and so on. Nothing is kept for any of them, because poses may be many.
struct CsvPoseColumns {
  std::size_t poses = 0;                                             ///< columns
  std::string unit = "1";                                            ///< in their headings, see with_unit()
  std::function<Number(std::size_t line, std::size_t pose)> number;  ///< SI, or in that unit
};

/// A CSV file: in the first line the names of the columns, then one line for each thing.
struct CsvTable {
  std::string name;                                ///< of the file, without ".csv"
  CsvText first;                                   ///< the first cell of a line
  std::size_t lines = 0;                           ///< without the names
  std::vector<CsvColumn> columns = {};             ///< NaN is written as "NaN", a whole number with all its digits
  CsvText last = {};                               ///< a cell after the numbers; none where it has no heading
  std::function<bool(std::size_t line)> has = {};  ///< whether the file has this line; all where empty
  std::vector<CsvText> more = {};                  ///< cells between the first one and the numbers
  std::vector<CsvText> rest = {};                  ///< cells after the last one
  CsvPoseColumns at_poses = {};                    ///< numbers behind those of `columns`
};

/// Several, in the order in which they are listed.
using CsvTables = std::vector<CsvTable>;

/// A text as a cell of a CSV file has it (RFC 4180): in quotes where it holds a comma, a semicolon or a quote, which is
/// doubled then; "?" for control characters, line ends among them. In front of a text that begins with = + - or @ an
/// apostrophe is put, because spreadsheets take such a text for a formula, in quotes as well.
std::string csv_cell(std::string_view text);

/// "name [unit]", or the name alone for a pure number.
std::string with_unit(const std::string& name, const std::string& unit);

/// Writes it into an existing folder. Gives the path. Throws FileError.
std::string write_csv(const std::string& folder, const CsvTable& table);

/// The SI units of things that may differ: "m", or "m or rad".
std::string si_units(const std::vector<NamedUnit>& things);
std::string display_units(const std::vector<NamedUnit>& things);  ///< The units in which people read them: "mm or deg".

/// The unit of a row of fields.h in CSV. response: of its numbers, where they belong to one.
std::string csv_unit(const std::string& unit, const StoredResult& result, const NamedUnit* response = nullptr);

/// A table with a line for each error of the result.
CsvTable lines_of_factors(const StoredResult& result, std::string name);
CsvTable lines_of_poses(const StoredResult& result, std::string name);  ///< A table with a line for each pose.

/// A column of the elements of a list, or of get(element). Refers to the elements.
template <class List, class Get = std::identity>
CsvColumn list_column(std::string heading, const List& list, Get get = {}) {
  return {std::move(heading),
          [elements = std::span(list), get](std::size_t line) { return to_number(std::invoke(get, elements[line])); }};
}

/// The same of a row of fields.h, from this element on.
template <class Found>
CsvColumn field_column(std::string heading, const FieldRow<Found>& field, const Found& found, std::size_t first = 0) {
  return {std::move(heading),
          [&field, &found, first](std::size_t line) { return number_at(field, found, first + line); }};
}

/// The same of a row along several axes: its elements at this position on the first one.
template <class Found>
CsvColumn field_row_column(std::string heading, const FieldRow<Found>& field, const Found& found, std::size_t at) {
  return {std::move(heading),
          [&field, &found, at](std::size_t line) { return field.member->number_in_row(found, at, line); }};
}

/// A column for each pose of an array whose last axes are that of the lines and the poses. at: positions on the axes
/// before.
template <class T, NamedAxis... Axes, std::integral... Positions>
CsvPoseColumns pose_columns(const Array<T, Axes...>& array, std::string unit, Positions... at) {
  return {array.template length<axis::Pose>(), std::move(unit),
          [&array, at...](std::size_t line, std::size_t pose) { return to_number(array(at..., line, pose)); }};
}

/// A table with a line for each error and a column for each pose, of a row along [factor x pose].
template <class Found>
CsvTable cell_table(const StoredResult& result, std::string name, const FieldRow<Found>& field, const Found& found) {
  CsvTable table = lines_of_factors(result, std::move(name));
  table.at_poses = {
      result.poses.size(), csv_unit(field.unit, result),
      [&field, &found](std::size_t line, std::size_t pose) { return field.member->number_in_row(found, line, pose); }};
  return table;
}

/// The same of a row along [response x factor x pose], for one of the responses.
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
