#pragma once

#include <optional>
#include <string>

#include "engine/model/model.h"
#include "engine/report/table.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Where a model without errors has its joints and frames at these poses, in mm and in the base frame: the frames of
/// each limb, of which 0 is the base's, the last one the platform's, and the others those of the axes of its joints
/// after these have moved, with z about or along the axis; and the joints as pictures show them, with their first axis
/// as z, each at the origin of a frame before it moves. None where the model has no picture. Precondition: the poses
/// are reachable.
std::optional<Table> frames_table(const Model& model, const PoseSet& poses);

/// A table as CSV: in the first line the names of the columns with their units, numbers with all digits.
std::string csv_of(const Table& table);

}  // namespace poesy
