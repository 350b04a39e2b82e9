#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/study/machine_file.h"
#include "engine/study/study.h"
#include "engine/study/table_file.h"

/// Checks of numbers in tables whose first line states no unit. Such numbers are read as SI. If the numbers look as if
/// another unit was meant, each function returns a warning for the user, which begins with the table's name. Otherwise
/// the text is empty.
namespace poesy {

/// A warning if poses of a table are outside the mechanism's workspace. poses: the poses of the table, or poses that
/// are interpolated between its points.
std::string bare_pose_text(std::string_view file, const PoseTable& table, const PoseSet& poses,
                           const ModelDescription& model);

/// All warnings about numbers without a unit in the tables that the study names, one line for each warning. poses: the
/// poses that the study selects.
std::vector<std::string> doubts_of(const Study& study, const SelectedPoses& poses);

/// A warning if an error is more than ten times as large as the study's distribution of it (error_size()).
std::string bare_error_text(std::string_view file, const ErrorTable& table, const Study& study);

/// A warning if measurements of a machine look too large. A deviation, its standard deviation and the distance of a
/// measured place from its pose should be at most ten times as large as the study's largest error of the same
/// dimension. A measured distance should be at most ten times as long as the workspace.
std::string bare_measurement_text(std::string_view file, const MachineFile& measurements, const Study& study);

/// A warning if a measured value is more than ten times as large as `usual`, the distribution of the study's other
/// errors of this dimension.
std::string bare_column_text(std::string_view file, const MeasuredColumn& column, Dimension dimension,
                             const Distribution& usual);

}  // namespace poesy
