#pragma once

#include <cstddef>
#include <string>

#include "engine/model/model.h"
#include "engine/model/sketch.h"

namespace poesy {

/// The name of a joint in words, from its type and its number: "U joint 1". limb: index from 0. joint: counted from 1
/// at the base; 0 gives the body where the limb begins, and the number after the last joint the body where the limb
/// ends.
std::string joint_words(const Sketch& sketch, std::size_t limb, std::size_t joint);

/// The name of a joint, with the name of the drive if a drive moves the joint: "q", "q, driven by motor_1".
std::string name_words(const SketchedJoint& joint);

/// The part of a limb between the joints `after` and `before` in words: "between the base and U joint 1", "inside U
/// joint 1". Joints are counted as in SketchedError.
std::string between_words(const Sketch& sketch, std::size_t limb, std::size_t after, std::size_t before);

/// The axis of an error: "rotation about x of frame 4", "displacement along x of the base".
std::string axis_words(const Sketch& sketch, const SketchedError& error);

}  // namespace poesy
