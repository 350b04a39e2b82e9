#pragma once

#include <span>
#include <vector>

#include "engine/model/sketch.h"
#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// Completes a sketch with named joints at these nominal displacements [all joints] (rad, m): sets points and axes of
/// its joints, platform and tool, frames and errors. In a limb of n joints an error of frame j is measured in frame j,
/// one of frame n in the platform (frame_with_error). With errors_at_joints the frames of base and platform are drawn
/// at the first and the last joint, where errors turn. Precondition: SketchedJoint::first and frame are those of the
/// model's chain.
void place(Sketch& sketch, const DeformationModel& model, std::span<const double> displacements);

/// A limb's frames (base_T_frame) before and after each joint has moved.
struct LimbFrames {
  std::vector<lie::Transform<double>> before;  ///< [n] frames of the joints
  std::vector<lie::Transform<double>> after;   ///< [n + 2] of the first body, the joints, and the last body
};

/// Adds the joints and frames of one limb to the sketch. sketch.frames contains those of the preceding limbs.
void place_limb(Sketch& sketch, const LimbFrames& frames, bool errors_at_joints);

/// The sketch of an error by its first term, of a limb that place_limb() has added, without its motions.
SketchedError sketched_error(const Sketch& sketch, const ErrorTerm& term);

}  // namespace poesy::chain
