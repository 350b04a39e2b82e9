#pragma once

#include <cstddef>
#include <string>

#include "engine/model/model.h"
#include "engine/model/sketch.h"

namespace poesy {

/// A joint of a limb (from 0) by its type and its number from the base: "U joint 1". Joint 0 is the body where the limb
/// begins; the joint after the last is the body where it ends.
std::string joint_words(const Sketch& sketch, std::size_t limb, std::size_t joint);

/// The joint's name, with that of its drive if it has one: "q", "q, driven by motor_1".
std::string name_words(const SketchedJoint& joint);

/// A place in a limb: "between the base and U joint 1", "inside U joint 1". Joints are counted as in SketchedError.
std::string between_words(const Sketch& sketch, std::size_t limb, std::size_t after, std::size_t before);

/// The axis of an error: "rotation about x of frame 4", "displacement along x of the base".
std::string axis_words(const Sketch& sketch, const SketchedError& error, Dimension dimension);

}  // namespace poesy
