#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "engine/model/model.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// A coordinate of a pose that is outside the mechanism's workspace.
struct OutsidePose {
  std::size_t pose;        ///< index of the pose in the list
  std::size_t coordinate;  ///< index of the coordinate in a pose
};

/// The first coordinate that is outside the workspace by more than this share of the workspace's range, and the first
/// pose where it is; none if there is none.
std::optional<OutsidePose> outside_pose(const PoseSet& poses, const ModelDescription& model, double share);

/// A clause that says where such a pose is: "pose 2 has z = 700 mm, outside the workspace from -300 mm to -180 mm".
/// text: the words for a value in SI.
std::string outside_clause(const OutsidePose& outside, const PoseSet& poses, const ModelDescription& model,
                           std::string (*text)(Quantity));

/// The clause about the first pose that is farther outside the workspace than the workspace is wide, as poses in
/// another unit are; empty if there is none.
std::string far_outside_clause(const PoseSet& poses, const ModelDescription& model);

}  // namespace poesy
