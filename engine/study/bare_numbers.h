#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/study/study.h"
#include "engine/study/table_file.h"

/// Checks numbers of tables whose first line states no unit, which are SI. If they look as if another unit was meant,
/// each function returns a line for people that begins with the table's name; otherwise an empty text.
namespace poesy {

/// Checks whether poses are outside the mechanism's workspace. poses: those of the table, or between its points.
std::string bare_pose_text(std::string_view file, const PoseTable& table, const PoseSet& poses,
                           const ModelDescription& model);

/// The lines for all tables that the study names. poses: those that it selects.
std::vector<std::string> doubts_of(const Study& study, const SelectedPoses& poses);

/// Checks whether an error is more than ten times as large as in the study (error_size).
std::string bare_error_text(std::string_view file, const ErrorTable& table, const Study& study);

/// Checks whether a measured value is more than ten times as large as errors of its dimension usually are, SI.
std::string bare_column_text(std::string_view file, const MeasuredColumn& column, Dimension dimension,
                             const Distribution& usual);

}  // namespace poesy
