#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Labels that a user gave to the rows of a table, such as serial numbers of parts.
struct RowLabels {
  std::string column;              ///< title of the column of labels: "part"
  std::vector<std::string> names;  ///< [rows] labels, all different; empty if the rows have none
};

/// Errors from a table. Each row of the table has a value for each of its factors.
struct ErrorTable {
  std::vector<FactorIndex> factors;  ///< factors, one for each column
  std::vector<double> values;        ///< [rows x factors] errors, row-major, SI
  std::size_t rows = 0;              ///< number of rows
  RowLabels labels{};                ///< labels of the rows
  std::vector<bool> bare{};  ///< [factors] true if the column lacks a unit that it needs; empty if no file was read

  /// The values of one factor in all rows, SI. Precondition: the factor is in `factors`.
  std::vector<double> column(FactorIndex factor) const;
};

/// A column of measured values of an error.
struct MeasuredColumn {
  std::string name;            ///< title without the unit
  std::vector<double> values;  ///< values in the order of the lines, SI
  bool bare = false;           ///< true if the file states no unit
};

/// Reads poses from a CSV file. The first line names all of the model's pose coordinates, or all coordinates of one of
/// the model's charts, in any order; each further line is a pose. A name may have a unit in brackets ("z [mm]");
/// numbers without a unit are SI. The columns "pose", "time" (or "t") and "condition", which `poesy export` writes into
/// poses.csv, are ignored. The result has the coordinates in the order of the pose or chart, SI. The function does not
/// check whether the model reaches the poses. Throws InputError with line and column for a missing, unknown or repeated
/// column, a unit of another dimension, columns that mix coordinates, a cell that is not a finite number, a line with
/// too few or many cells, or no data. Throws FileError if the file cannot be read.
PoseTable read_poses(const std::string& path, const ModelDescription& model);

/// Reads a trajectory from a CSV file like read_poses(), with an additional column "t" or "time" (s, or the stated
/// unit). Also throws InputError if times are not strictly ascending or are beyond kLatestTime, or if there is only one
/// point.
TimedPoints read_trajectory(const std::string& path, const ModelDescription& model);

/// Reads errors from a CSV file. The first line names factors of the model, any subset in any order, with units as in
/// read_poses(); each further line is a sample. The columns "sample", "pose" and "case", which `poesy export` writes
/// into errors.csv, are ignored. Any other column is a column of text if at least one of its cells has a letter and
/// none begins like a number. A column of text is ignored unless it labels the rows.
///
/// The labels of the rows are in the first of these columns that the table has:
/// - a column "part" or "name";
/// - a column with a title such as "serial", which is renamed "part";
/// - a column with a title such as "Part No.", also of numbers, if its cells are valid labels (label_problem()) and
/// differ; it is renamed "part";
/// - a column of text under the same conditions, if the table has at least two rows; it is renamed "part".
///
/// Throws as read_poses() does. Also throws InputError for an unknown factor, for an invalid or repeated label in a
/// column of the first two kinds, for a column with a title such as "Part No." that has neither letters nor valid
/// labels, and for an error that is too large (Model::error_bound).
ErrorTable read_errors(const std::string& path, const Model& model);

/// Reads one column of measured values from a CSV file. The first line names the columns. The column is found by its
/// name with or without unit, "hole [mm]" or "hole"; numbers without a unit are SI. Other columns may have any content.
/// Throws InputError with line and column for a column that is missing or repeated, a unit of another dimension, a cell
/// of the column that is not a finite number, a line with too few or many cells, or no data. Throws FileError if the
/// file cannot be read.
MeasuredColumn read_column(const std::string& path, std::string_view column, Dimension dimension);

/// Explains, as a clause ("begins with '='"), what is wrong with a user's name for a row of a table; none if the name
/// can be used in tables, CSV, spreadsheets and pages. A name has 1 to 60 bytes of printable UTF-8 on one line, without
/// commas, semicolons and quotes. It does not begin with = + - or @, because spreadsheets would take it for a formula.
std::optional<std::string> label_problem(std::string_view label);

/// The rule of label_problem() in words, for advice and for the explanation of a key.
/// @{
inline constexpr std::string_view kLabelRule =
    "write at most 60 bytes of printable text without commas, semicolons and quotes, not beginning with = + - or @";
inline constexpr std::string_view kNameMeaning =
    "Its name: at most 60 bytes, no commas, semicolons or quotes, no = + - @ at its beginning.";
/// @}

}  // namespace poesy
