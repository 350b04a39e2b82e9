#pragma once

#include <span>
#include <vector>

#include "engine/model/sketch.h"
#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// Puts a sketch whose joints are named at these nominal displacements [all joints] (rad, m): sets points and axes of
/// its joints, platform and tool, frames and errors. An error of frame j of a limb of n joints is measured in frame j,
/// but for that of frame n, which is measured in the platform (frame_with_error). With errors_at_joints base and
/// platform are shown where errors turn, at the first and the last joint. Precondition: SketchedJoint::first and frame
/// are those of the model's chain.
void place(Sketch& sketch, const DeformationModel& model, std::span<const double> displacements);

/// A limb's frames (base_T_frame) before and after each joint has moved.
struct LimbFrames {
  std::vector<lie::Transform<double>> before;  ///< [n] of its joints
  std::vector<lie::Transform<double>> after;   ///< [n + 2] of the body where it begins, its joints, that where it ends
};

/// Puts the joints and frames of one limb there. sketch.frames has those of the limbs before it.
void place_limb(Sketch& sketch, const LimbFrames& frames, bool errors_at_joints);

/// An error of a limb that has been placed, without its motions.
SketchedError sketched_error(const Sketch& sketch, const ErrorSlot& slot);

}  // namespace poesy::chain
