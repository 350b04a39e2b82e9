#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/study/study.h"
#include "engine/study/table_file.h"

/// Numbers of tables whose first line names no unit for them: they are SI. Where they look as if another unit was
/// meant, each function gives a line for people that begins with the table's name; else an empty text.
namespace poesy {

/// Where a pose lies outside the mechanism's workspace. poses: those of the table, or between its points.
std::string bare_pose_text(std::string_view file, const PoseTable& table, const PoseSet& poses,
                           const ModelDescription& model);

/// Of all tables that the study names; poses: those that it selects.
std::vector<std::string> doubts_of(const Study& study, const SelectedPoses& poses);

/// Where an error is more than ten times as large as the study has it (error_size).
std::string bare_error_text(std::string_view file, const ErrorTable& table, const Study& study);

/// Where a measured value is more than ten times as large as the errors of its dimension usually are, SI.
std::string bare_column_text(std::string_view file, const MeasuredColumn& column, Dimension dimension,
                             const Distribution& usual);

}  // namespace poesy
