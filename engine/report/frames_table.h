#pragma once

#include <optional>
#include <string>

#include "engine/model/model.h"
#include "engine/report/table.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// A table of the joints and frames of a model without errors at these poses, in mm and in the base frame. Frame 0 of a
/// limb is at the base, and its last frame is at the platform. The other frames are at the axes of the limb's joints,
/// with z along the axis, after the joints have moved. A joint is shown as in pictures: at the origin of a frame before
/// the joint moves, with its first axis as z. None if the model has no picture. Precondition: the model reaches the
/// poses.
std::optional<Table> frames_table(const Model& model, const PoseSet& poses);

/// A table as CSV. The first line has the names of the columns with their units. Numbers have all digits.
std::string csv_of(const Table& table);

}  // namespace poesy
