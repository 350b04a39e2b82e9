#pragma once

#include <optional>
#include <string>

#include "engine/model/model.h"
#include "engine/report/table.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// A table of the joints and frames of a model without errors at these poses, in mm and in the base frame. Frame 0 of a
/// limb is at the base and the last one at the platform; the others are at the axes of its joints after these have
/// moved, with z along the axis. Joints are as in pictures, with their first axis as z, each at the origin of a frame
/// before it moves. None if the model has no picture. Precondition: the poses are reachable.
std::optional<Table> frames_table(const Model& model, const PoseSet& poses);

/// A table as CSV: the first line has the names of the columns with their units; numbers have all digits.
std::string csv_of(const Table& table);

}  // namespace poesy
