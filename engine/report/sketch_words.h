#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "engine/model/model.h"
#include "engine/model/sketch.h"

namespace poesy {

/// The name of a joint in words, from its type and its number: "U joint 1". limb: index from 0. joint: counted from 1
/// at the base. The number 0 gives the body where the limb begins; the number after the last joint gives the body where
/// it ends.
std::string joint_words(const Sketch& sketch, std::size_t limb, std::size_t joint);

/// The name of a joint in the mechanism's file, with the name of its drive if it has one: "q", "q, driven by motor_1".
std::string name_words(const SketchedJoint& joint);

/// The part of a limb between the joints `after` and `before` in words: "between the base and U joint 1 (A)", "inside
/// U joint 1 (A)", with the names of joints in the mechanism's file. Joints are counted as in SketchedError.
std::string between_words(const Sketch& sketch, std::size_t limb, std::size_t after, std::size_t before);

/// How an error displaces its part: "displacement along x of the base", "rotation about x of frame 4, (0.6, 0, 0.8) in
/// the base at home". The direction in the base is left out if it is that of the base's axis of the same name. An error
/// of a feature turns or moves the feature: "leans to x, where x is (0.6, 0, 0.8) at home". sketch: the mechanism at
/// home. name, description: those of the error in ModelDescription::factors.
std::string axis_words(const Sketch& sketch, const SketchedError& error, std::string_view name,
                       std::string_view description);

}  // namespace poesy
