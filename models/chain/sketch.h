#pragma once

#include <span>
#include <vector>

#include "engine/model/sketch.h"
#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// Completes a sketch with named joints at nominal displacements [all joints] (rad, m): sets the points and axes of
/// joints, platform and tool, the frames, and the errors. In a limb of n joints, an error of frame j < n is measured in
/// frame j, and an error of frame n in the platform's frame (frame_with_error). With errors_at_joints the frames of
/// base and platform are drawn at the first and the last joint, about which errors rotate. Precondition:
/// SketchedJoint::first and SketchedJoint::frame are indices of frames of the model's chain.
void place(Sketch& sketch, const DeformationModel& model, std::span<const double> displacements);

/// The frames of a limb (base_T_frame) before and after each joint has moved.
struct LimbFrames {
  std::vector<lie::Transform<double>> before;  ///< frame of each joint before it moves
  /// Frames of the first body, of each joint after it has moved, and of the last body.
  std::vector<lie::Transform<double>> after;
};

/// Adds the joints and frames of one limb to the sketch. sketch.frames already contains those of the preceding limbs.
void place_limb(Sketch& sketch, const LimbFrames& frames, bool errors_at_joints);

/// The motions [omega; v] of the limbs' ends by an error; one motion if all are equal up to rounding. moves: the norm
/// of the largest motion of an end that the error causes if no joint moves. Differences count as rounding if they are
/// small compared with this norm.
std::vector<SketchTwist> sketched_motions(std::vector<lie::Screw<double>> motions, double moves);

/// The sketch of the error with these terms, without its motions. It is drawn in the frame of the first term.
/// place_limb() must have added the limb of that term.
SketchedError sketched_error(const Sketch& sketch, const ErrorTerms& terms);

}  // namespace poesy::chain
