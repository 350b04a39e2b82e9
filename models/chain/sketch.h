#pragma once

#include <span>

#include "engine/model/sketch.h"
#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// Puts a sketch whose joints are named at these nominal displacements [all joints] (rad, m): sets points and axes of
/// its joints, platform and tool, frames and errors. An error of frame j of a limb of n joints is measured in frame j,
/// but for that of frame n, which is measured in the platform (frame_with_error). With errors_at_joints base and
/// platform are shown where errors turn, at the first and the last joint. Precondition: SketchedJoint::first and frame
/// are those of the model's chain.
void place(Sketch& sketch, const DeformationModel& model, std::span<const double> displacements);

}  // namespace poesy::chain
