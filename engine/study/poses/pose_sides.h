#pragma once

#include <cstddef>
#include <optional>

#include "engine/model/model.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// The index of a pose that a machine cannot reach from pose 0 without passing a singular pose
/// (Model::are_separated()); none if no such pose is known. At most 30 poses are tried, evenly spread over the list.
/// Each is compared with the nearest pose that is known to be on the side of pose 0, by way of poses between them.
std::optional<std::size_t> pose_beyond_singularity(const Model& model, const PoseSet& poses);

}  // namespace poesy
