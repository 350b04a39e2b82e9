#include "engine/report/sketch_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/model/feature_errors.h"

namespace poesy {

namespace {

std::string body_words(const Sketch& sketch, std::size_t body) {
  if (body == 0) return "the base";
  return body == 1 ? "the platform" : sketch.bodies[body].name;
}

/// Returns true if an error of this name belongs to a feature of the error's limb.
bool is_of_feature(const Sketch& sketch, const SketchedError& error, std::string_view name) {
  return std::ranges::any_of(sketch.features, [&](const SketchedFeature& feature) {
    return feature.limb == error.limb && std::ranges::any_of(kFeatureDirections, [&](std::string_view direction) {
             return name == feature_error_name(feature.name, direction, error.limb + 1);
           });
  });
}

/// The description of an error of a feature, without the name of the feature and without sizes: "leans to x, where x is
/// (0.6, 0, 0.8) at home" for "bore of limb 1 leans to x: its far end against its near end, 30 mm apart, where x is
/// (0.6, 0, 0.8) at home".
std::string feature_words(std::string_view description) {
  constexpr std::string_view kLimb = " of limb ";
  constexpr std::string_view kAxes = ", where ";
  const std::size_t limb = std::min(description.find(kLimb), description.size());
  const std::size_t verb = description.find(' ', limb + kLimb.size());
  if (verb == std::string_view::npos) return std::string(description);
  const std::string_view what = description.substr(verb + 1);
  const std::size_t axes = std::min(what.find(kAxes), what.size());
  return std::string(what.substr(0, std::min(what.find(':'), axes))) + std::string(what.substr(axes));
}

/// A direction to three decimals: "(0.471, 0, 0.882)".
std::string direction_text(const SketchVector& direction) {
  constexpr double kDecimals = 1e3;
  const auto rounded = [&](std::size_t c) { return std::round(kDecimals * direction[c]) / kDecimals + 0.0; };
  return fmt::format("({}, {}, {})", rounded(0), rounded(1), rounded(2));
}

/// The direction of an axis of a frame, in the base frame. Empty if it is that of the base's axis of the same name.
std::string direction_in_base(const SketchedFrame& frame, std::size_t axis) {
  SketchVector of_base{};
  of_base[axis] = 1.0;
  std::string text = direction_text(frame.axes[axis]);
  return text == direction_text(of_base) ? std::string() : ", " + text + " in the base at home";
}

/// Like joint_words(), followed by the joint's name in the mechanism's file: "U joint 1 (A)".
std::string named_joint_words(const Sketch& sketch, std::size_t limb, std::size_t joint) {
  const std::string words = joint_words(sketch, limb, joint);
  const std::vector<SketchedJoint>& joints = sketch.limbs[limb];
  if (joint == 0 || joint > joints.size() || joints[joint - 1].name.empty()) return words;
  return fmt::format("{} ({})", words, joints[joint - 1].name);
}

}  // namespace

std::string joint_words(const Sketch& sketch, std::size_t limb, std::size_t joint) {
  const std::vector<SketchedJoint>& joints = sketch.limbs[limb];
  if (joint == 0) return body_words(sketch, sketch.ends_of(limb).from);
  if (joint > joints.size()) return body_words(sketch, sketch.ends_of(limb).to);
  const char type = joints[joint - 1].type;
  return type == 'F' ? fmt::format("fixed frame {}", joint) : fmt::format("{} joint {}", type, joint);
}

std::string name_words(const SketchedJoint& joint) {
  return joint.drive.empty() ? joint.name : fmt::format("{}, driven by {}", joint.name, joint.drive);
}

std::string between_words(const Sketch& sketch, std::size_t limb, std::size_t after, std::size_t before) {
  if (after == before) return "inside " + named_joint_words(sketch, limb, after);
  return fmt::format("between {} and {}", named_joint_words(sketch, limb, after),
                     named_joint_words(sketch, limb, before));
}

std::string axis_words(const Sketch& sketch, const SketchedError& error, std::string_view name,
                       std::string_view description) {
  if (is_of_feature(sketch, error, name)) return feature_words(description);
  const std::size_t last = sketch.frames[error.limb].size() - 1;
  const SketchedEnds ends = sketch.ends_of(error.limb);
  const std::string frame = error.frame == 0      ? body_words(sketch, ends.from)
                            : error.frame == last ? body_words(sketch, ends.to)
                                                  : fmt::format("frame {}", error.frame);
  std::string at;
  if (error.turns && sketch.errors_at_joints && error.frame == 0) at = ", at the first joint";
  if (error.turns && sketch.errors_at_joints && error.frame == last) at = ", at the last joint";
  return fmt::format("{} {} of {}{}{}", error.turns ? "rotation about" : "displacement along", "xyz"[error.axis], frame,
                     at, direction_in_base(sketch.frames[error.limb][error.frame], error.axis));
}

}  // namespace poesy
