#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/study/machine_file.h"
#include "engine/study/study.h"
#include "engine/study/table_file.h"

/// Checks of numbers in tables. Numbers of a column without a unit in the first line are read as SI. If such numbers
/// look as if the user meant another unit or sign, the functions return a warning that begins with the name of the
/// file; otherwise an empty text.
namespace poesy {

/// Warns of poses outside the mechanism's workspace, even if the table states units, because a sign may be wrong.
/// poses: the poses of the table, or poses that are interpolated between the points of the table.
std::string outside_pose_text(std::string_view file, const PoseTable& table, const PoseSet& poses,
                              const ModelDescription& model);

/// All warnings about numbers in the tables that the study names, and about the boxes in which it seeks poses
/// (workspace_doubts()), one line for each warning. poses: the poses that the study selects.
std::vector<std::string> doubts_of(const Study& study, const SelectedPoses& poses);

/// Warnings about a table of errors, one line for each:
/// - a row whose label says that it is no part, such as "mean" or, among parts, "USL";
/// - an error that is more than ten times as large as the study's errors of this factor (error_size()), if it is a
///   number without dimension or its column states no unit;
/// - if neither is found, a value that is far larger than the others of its column (odd_value_text()).
std::vector<std::string> error_table_doubts(std::string_view file, const ErrorTable& table, const Study& study);

/// Warns of measured values in columns without a unit that look too large. A deviation, a standard deviation, and the
/// difference between a measured and a commanded coordinate should be at most ten times the study's largest error of
/// the same dimension. A measured distance should be at most ten times the diagonal of the workspace.
std::string bare_measurement_text(std::string_view file, const MachineFile& measurements, const Study& study);

/// Warns of a measured value, in a column without a unit, that is more than ten times as large as the errors of `usual`
/// (error_size()), the distribution of the study's other errors of this dimension.
std::string bare_column_text(std::string_view file, const MeasuredColumn& column, Dimension dimension,
                             const Distribution& usual);

/// Warns of the largest magnitude of a column, with or without a unit, if it is more than a hundred times the median
/// magnitude of the column: it may be in another unit than the others. No warning for fewer than five values.
std::string odd_value_text(std::string_view file, std::string_view column, Dimension dimension,
                           std::span<const double> values);

}  // namespace poesy
