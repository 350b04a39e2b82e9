#pragma once

#include <span>
#include <string>

#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Says in which coordinate a box is apart from the workspace that the mechanism states, or touches it only: "z is from
/// 380 mm to 500 mm, in the mechanism's workspace from -500 mm to -380 mm". Empty if they overlap.
std::string apart_clause(std::span<const Range> box, const ModelDescription& model);

/// Says what in the box of a selection looks like a wrong sign or unit:
/// - the box is apart from the workspace that the mechanism states (apart_clause());
/// - in one coordinate, less than half of the box is in the mechanism's workspace, and more than half of the selected
/// poses are outside it: a study may widen or shift the workspace a little;
/// - an angle of the box is more than a full turn, although the mechanism's own workspace has no such angle.
/// Empty if nothing does, or if the selection has no box. poses: the poses that it selects; empty: not known, so the
/// second point is left out.
std::string unusual_workspace(const PoseSelection& selection, const PoseSet& poses, const ModelDescription& model);

}  // namespace poesy
