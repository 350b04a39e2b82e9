#pragma once

#include <cstddef>
#include <string>

#include "engine/model/model.h"
#include "engine/model/sketch.h"

namespace poesy {

/// "U joint 1": a joint of a limb (from 0) by its kind and its number from the base; the body where the limb begins
/// for 0, that where it ends for one more than there are joints.
std::string joint_words(const Sketch& sketch, std::size_t limb, std::size_t joint);

/// "q", "q, driven by motor_1": the joint's name, and the drive's where it has one.
std::string name_words(const SketchedJoint& joint);

/// "between the base and U joint 1", "inside U joint 1": where joints count as in SketchedError.
std::string between_words(const Sketch& sketch, std::size_t limb, std::size_t after, std::size_t before);

/// "rotation about x of frame 4", "displacement along x of the base".
std::string axis_words(const Sketch& sketch, const SketchedError& error, Dimension dimension);

}  // namespace poesy
