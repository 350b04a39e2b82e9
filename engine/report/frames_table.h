#pragma once

#include <optional>
#include <string>

#include "engine/model/model.h"
#include "engine/report/table.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// A table of the joints and frames of a model without errors at these poses: positions in mm, and directions of the
/// axes, in the base frame. Frame 0 of a limb is that of the base, the last one that of the platform. Each frame
/// between them belongs to one axis of a joint: the z axis of the frame is this axis, and the frame is shown after the
/// joint has moved. A joint is shown as in pictures: its position is the origin of its frame before the joint moves,
/// and z is its first axis. None if the model has no picture. Precondition: the model reaches the poses.
std::optional<Table> frames_table(const Model& model, const PoseSet& poses);

/// A table as CSV. The first line has the names of the columns with their units. Numbers have all digits.
std::string csv_of(const Table& table);

}  // namespace poesy
