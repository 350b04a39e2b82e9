#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Labels of rows that a user gave.
struct RowLabels {
  std::string column;              ///< what they name: "part"
  std::vector<std::string> names;  ///< [S], all different
};

/// Errors from a table: S rows of V factors.
struct ErrorTable {
  std::vector<FactorIndex> factors;  ///< [V]
  std::vector<double> values;        ///< [S x V], row-major, SI
  std::size_t rows = 0;              ///< S
  RowLabels labels{};                ///< labels of the rows; empty if they have none
  std::vector<bool> bare{};          ///< [V] whether the file states no unit; empty if no file was read

  /// [S] The values of a factor. Precondition: it is among `factors`.
  std::vector<double> column(FactorIndex factor) const;
};

/// Measured values, SI.
struct MeasuredColumn {
  std::string name;            ///< without its unit
  std::vector<double> values;  ///< values in the order of the lines
  bool bare = false;           ///< whether the file states no unit
};

/// Reads poses from CSV. The first line names all of the model's pose coordinates, or all coordinates of one of its
/// charts, in any order; each further line is a pose. A name may have a unit in brackets ("z [mm]"); otherwise numbers
/// are SI. The columns "pose", "time" (or "t") and "condition", which `poesy export` writes into poses.csv, are
/// ignored. Points are returned in the model's order of coordinates, SI. Whether the model reaches the poses is not
/// checked. Throws InputError with line and column for a missing, unknown or repeated column, a unit that does not fit,
/// columns that mix coordinates, a cell that is not a finite number, a line with too few or many cells, or no data;
/// FileError if the file cannot be read.
PoseTable read_poses(const std::string& path, const ModelDescription& model);

/// Reads a trajectory from CSV: see read_poses(), with a column "t" or "time" (s, or its stated unit). Also throws
/// InputError for times that do not ascend strictly, and for a single row.
TimedPoints read_trajectory(const std::string& path, const ModelDescription& model);

/// Reads errors from CSV. The first line names factors of the model, any subset in any order, with units as in
/// read_poses(); each further line is a sample. A column "part" or "name" labels the rows (label_problem(), all
/// different). The columns "sample", "pose" and "case", which `poesy export` writes into errors.csv, are ignored, as
/// are other columns of text ("operator"), in which some cell has a letter and no cell begins like a number. Throws as
/// read_poses(), and InputError for an unknown factor and for an error that makes no sense (Model::error_bound).
ErrorTable read_errors(const std::string& path, const Model& model);

/// Reads one column of measured values from CSV. The first line names columns; this one is found by its name with or
/// without unit, "hole [mm]" or "hole", and without a unit numbers are SI. Other columns may have anything. Throws
/// InputError with line and column for a column that is missing or repeated, a unit that does not fit, a cell of the
/// column that is not a finite number, a line with too few or many cells, or no data; FileError if the file cannot be
/// read.
MeasuredColumn read_column(const std::string& path, std::string_view column, Dimension dimension);

/// What is wrong with a user's name for a row, as a clause ("begins with '='"); none if it can be used in tables, CSV,
/// spreadsheets and pages. A name has 1 to 60 bytes of printable UTF-8 on one line, without commas, semicolons and
/// quotes. It does not begin with = + - or @, which spreadsheets take for a formula.
std::optional<std::string> label_problem(std::string_view label);

/// The rule of label_problem() in words, for advice and for the meaning of a key.
/// @{
inline constexpr std::string_view kLabelRule =
    "write at most 60 bytes of printable text without commas, semicolons and quotes, not beginning with = + - or @";
inline constexpr std::string_view kNameMeaning =
    "Its name: at most 60 bytes, no commas, semicolons or quotes, no = + - @ at its beginning.";
/// @}

}  // namespace poesy
