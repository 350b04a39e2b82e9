#pragma once

#include <cstddef>
#include <string>

#include "engine/model/model.h"
#include "engine/model/sketch.h"

namespace poesy {

/// The name of a joint in words, by its type and its number from the base: "U joint 1". limb: index from 0. Joint 0 is
/// the body where the limb begins; the joint after the last is the body where the limb ends.
std::string joint_words(const Sketch& sketch, std::size_t limb, std::size_t joint);

/// The name of a joint, with that of its drive if it has one: "q", "q, driven by motor_1".
std::string name_words(const SketchedJoint& joint);

/// The part of a limb between two joints in words: "between the base and U joint 1", "inside U joint 1". Joints are
/// counted as in SketchedError.
std::string between_words(const Sketch& sketch, std::size_t limb, std::size_t after, std::size_t before);

/// The axis of an error: "rotation about x of frame 4", "displacement along x of the base".
std::string axis_words(const Sketch& sketch, const SketchedError& error);

}  // namespace poesy
