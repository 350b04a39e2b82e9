#pragma once

#include <span>
#include <string>

#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// A clause that names the first coordinate in which a box and the workspace that the mechanism states do not overlap:
/// "z is from 380 mm to 500 mm, in the mechanism's workspace from -500 mm to -380 mm". Empty if they overlap in all
/// coordinates. box: [pose coordinates], SI.
std::string apart_clause(std::span<const Range> box, const ModelDescription& model);

/// A clause that says what in the box of a selection (PoseSelection::workspace) looks like a wrong sign or unit:
/// - the box does not overlap the workspace that the mechanism states (apart_clause());
/// - in one coordinate, less than half of the box is in the mechanism's workspace, and more than half of the selected
///   poses are outside it; a smaller change of the workspace is often intended;
/// - the box has an angle beyond +-360 deg, although the mechanism's workspace has none;
/// - in one coordinate, the range of the box is less than a hundredth of the mechanism's.
///
/// Empty if nothing looks wrong, or if the selection has no box. poses: the selected poses; empty if they are not
/// known, and the second check is then left out.
std::string unusual_workspace(const PoseSelection& selection, const PoseSet& poses, const ModelDescription& model);

}  // namespace poesy
