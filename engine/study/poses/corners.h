#pragma once

#include "engine/model/model.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// The feasible poses among the corners of the box in which a study seeks poses (PoseSelection::workspace), in the
/// order of a grid with two points along each coordinate. No poses if the selection has no box, or if the box has more
/// than eight coordinates.
PoseSet feasible_corners(const PoseSelection& selection, const Model& model);

}  // namespace poesy
