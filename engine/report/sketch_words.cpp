#include "engine/report/sketch_words.h"

#include <fmt/format.h>

namespace poesy {

namespace {

std::string body_words(const Sketch& sketch, std::size_t body) {
  if (body == 0) return "the base";
  return body == 1 ? "the platform" : sketch.bodies[body].name;
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
  if (after == before) return "inside " + joint_words(sketch, limb, after);
  return fmt::format("between {} and {}", joint_words(sketch, limb, after), joint_words(sketch, limb, before));
}

std::string axis_words(const Sketch& sketch, const SketchedError& error) {
  const std::size_t last = sketch.frames[error.limb].size() - 1;
  const SketchedEnds ends = sketch.ends_of(error.limb);
  const std::string frame = error.frame == 0      ? body_words(sketch, ends.from)
                            : error.frame == last ? body_words(sketch, ends.to)
                                                  : fmt::format("frame {}", error.frame);
  std::string at;
  if (error.turns && sketch.errors_at_joints && error.frame == 0) at = ", at the first joint";
  if (error.turns && sketch.errors_at_joints && error.frame == last) at = ", at the last joint";
  return fmt::format("{} {} of {}{}", error.turns ? "rotation about" : "displacement along", "xyz"[error.axis], frame,
                     at);
}

}  // namespace poesy
