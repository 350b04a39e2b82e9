#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Names of rows that a user gave, so that he finds them again.
struct RowLabels {
  std::string column;              ///< what they name: "part"
  std::vector<std::string> names;  ///< [S], all different
};

/// Errors that somebody else sampled: S rows of V factors.
struct ErrorTable {
  std::vector<FactorIndex> factors;  ///< [V]
  std::vector<double> values;        ///< [S x V], row-major, SI
  std::size_t rows = 0;              ///< S
  RowLabels labels{};                ///< of the rows; empty where they have no names
  std::vector<bool> bare{};          ///< [V] whether a file names no unit for them; empty where no file was read
};

/// Values that were measured, SI.
struct MeasuredColumn {
  std::string name;            ///< without its unit
  std::vector<double> values;  ///< in the order of the lines
  bool bare = false;           ///< whether the file names no unit for them
};

/// Reads poses from CSV: the first line names all of the model's pose coordinates, or all coordinates of one of its
/// charts, in any order; then one pose a line. A name may have the unit of its numbers in brackets ("z [mm]"), else
/// they are SI. What else `poesy export` writes into poses.csv is passed over: columns "pose", "time" (or "t") and
/// "condition". Throws InputError with line and column for a missing, unknown or repeated column, a unit that does not
/// fit, columns that mix coordinates, a cell that is not a finite number, a line with too few or many cells, or no
/// data; FileError when the file cannot be read. The points come back in the model's order of coordinates, SI. Does not
/// ask whether the model has and reaches such poses.
PoseTable read_poses(const std::string& path, const ModelDescription& model);

/// Reads a trajectory from CSV: as read_poses, with a column "t" or "time" (s, or the unit that it names). Also throws
/// InputError for times that do not ascend strictly, and for a single row.
TimedPoints read_trajectory(const std::string& path, const ModelDescription& model);

/// Reads errors from CSV: the first line names factors of the model, any subset in any order, with units as in
/// read_poses; then one sample a line. A column "part" or "name" labels the rows (label_problem(), all different);
/// columns "sample", "pose" and "case", which `poesy export` writes into errors.csv, are passed over, and so are other
/// columns of text ("operator"): there is a letter in some cell, and none begins as a number does. Errors as
/// read_poses; an unknown factor is an InputError too, and so is an error that makes no sense (Model::error_bound).
ErrorTable read_errors(const std::string& path, const Model& model);

/// Reads one column of measured values from CSV. The first line names columns; the asked one by its name with its
/// unit or without, "hole [mm]" or "hole", and without a unit its numbers are SI. Other columns may hold anything.
/// Throws InputError with line and column for a column that is missing or there twice, a unit that does not fit, a cell
/// of the column that is not a finite number, a line with too few or many cells, or no data; FileError when the file
/// cannot be read.
MeasuredColumn read_column(const std::string& path, std::string_view column, Dimension dimension);

/// What a name that a user gives to a row may not be, as a clause ("begins with '='"), or none when it may stand in
/// tables, CSV, spreadsheets and pages as it is: 1 to 60 bytes of printable UTF-8 on one line, without commas,
/// semicolons and quotes, and not beginning with = + - or @, which spreadsheets take for a formula.
std::optional<std::string> label_problem(std::string_view label);

/// The rule of label_problem() in words: as a remedy, and as the meaning of a key.
/// @{
inline constexpr std::string_view kLabelRule =
    "write at most 60 bytes of printable text without commas, semicolons and quotes, not beginning with = + - or @";
inline constexpr std::string_view kNameMeaning =
    "Its name: at most 60 bytes, no commas, semicolons or quotes, no = + - @ at its beginning.";
/// @}

}  // namespace poesy
