#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Labels that a user gave to rows.
struct RowLabels {
  std::string column;              ///< title of the column of labels: "part"
  std::vector<std::string> names;  ///< [rows] labels, all different
};

/// Errors from a table. Each row of the table has a value for each of its factors.
struct ErrorTable {
  std::vector<FactorIndex> factors;  ///< factors, one for each column
  std::vector<double> values;        ///< [rows x factors] errors, row-major, SI
  std::size_t rows = 0;              ///< number of rows
  RowLabels labels{};                ///< labels of the rows; empty if they have none
  std::vector<bool> bare{};  ///< [factors] true if the file states no unit for the column; empty if no file was read

  /// The values of one factor in all rows, SI. Precondition: the factor is in `factors`.
  std::vector<double> column(FactorIndex factor) const;
};

/// A column of measured values.
struct MeasuredColumn {
  std::string name;            ///< title without the unit
  std::vector<double> values;  ///< values in the order of the lines, SI
  bool bare = false;           ///< true if the file states no unit
};

/// Reads poses from a CSV file. The first line names all of the model's pose coordinates, or all coordinates of one of
/// the model's charts, in any order; each further line is a pose. A name may have a unit in brackets ("z [mm]");
/// numbers without a unit are SI. The columns "pose", "time" (or "t") and "condition", which `poesy export` writes into
/// poses.csv, are ignored. The result has the coordinates in the model's order, SI. Whether the model reaches the poses
/// is not checked.
/// Throws InputError with line and column for a missing, unknown or repeated column, a unit of another dimension,
/// columns that mix coordinates, a cell that is not a finite number, a line with too few or many cells, or no data.
/// Throws FileError if the file cannot be read.
PoseTable read_poses(const std::string& path, const ModelDescription& model);

/// Reads a trajectory from a CSV file like read_poses(), with an additional column "t" or "time" (s, or the stated
/// unit). Also throws InputError if times are not strictly ascending, or if there is only one point.
TimedPoints read_trajectory(const std::string& path, const ModelDescription& model);

/// Reads errors from a CSV file. The first line names factors of the model, any subset in any order, with units as in
/// read_poses(); each further line is a sample. A column "part" or "name" gives labels to the lines, or, if there is
/// none, one with a title such as "serial", which is read as "part"; labels must differ and follow label_problem(). If
/// there is none of these, the first column of texts that may be labels names the lines, and is called "part": first
/// one with a title such as "Part No.", otherwise one of at least two lines. The columns "sample", "pose" and "case",
/// which `poesy export` writes into errors.csv, are ignored, and so are other columns of text, such as "operator". A
/// column is one of text if at least one of its cells has a letter and no cell begins like a number; with a title such
/// as "Part No." it may have any labels. Throws as read_poses() does, and InputError for an unknown factor, for a
/// column with such a title whose numbers are no labels, and for an error that is too large (Model::error_bound).
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
