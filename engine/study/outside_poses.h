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

/// The first coordinate that at some pose is outside the workspace by more than `share` of its range in the workspace,
/// and the first pose where this is so. None if all poses are inside.
std::optional<OutsidePose> outside_pose(const PoseSet& poses, const ModelDescription& model, double share);

/// A clause that says how a pose is outside the workspace: "pose 2 has z = 700 mm, outside the workspace from -300 mm
/// to -180 mm". text: function that writes a value (SI) as text.
std::string outside_clause(const OutsidePose& outside, const PoseSet& poses, const ModelDescription& model,
                           std::string (*text)(Quantity));

/// The outside_clause() of the outside_pose() that is farther outside the workspace than the workspace is wide, which
/// suggests a wrong unit. Empty if there is none.
std::string far_outside_clause(const PoseSet& poses, const ModelDescription& model);

}  // namespace poesy
