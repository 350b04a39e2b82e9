#pragma once

#include <optional>
#include <string>

#include "engine/model/model.h"
#include "engine/report/table.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// A table of the joints and frames of a model without errors at these poses, in mm and in the base frame. The first
/// frame of a limb, frame 0, is that of the base, and the last is that of the platform. Each frame between them belongs
/// to one axis of a joint: it is the frame behind that axis, after the joint has moved, and its z is the axis. A joint
/// is shown as in pictures: at the origin of a frame before the joint moves, with the joint's first axis as z. None if
/// the model has no picture. Precondition: the model reaches the poses.
std::optional<Table> frames_table(const Model& model, const PoseSet& poses);

/// A table as CSV. The first line has the names of the columns with their units. Numbers have all digits.
std::string csv_of(const Table& table);

}  // namespace poesy
