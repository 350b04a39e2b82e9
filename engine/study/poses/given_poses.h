#pragma once

#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// The poses of a file; see select_poses().
SelectedPoses file_poses(const PoseSelection& selection, const Model& model);

/// The poses along a trajectory, with their times; see select_poses().
SelectedPoses trajectory_poses(const PoseSelection& selection, const Model& model);

}  // namespace poesy
