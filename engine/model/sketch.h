#pragma once

#include <array>
#include <string>
#include <vector>

namespace poesy {

/// A point or a direction in the base frame (m), at home.
using SketchVector = std::array<double, 3>;

/// A joint as a picture shows it.
struct SketchedJoint {
  std::string name;    ///< as the mechanism's file has it
  char type;           ///< R, P, H, C, U or S; F for a fixed frame
  bool actuated;       ///< a drive holds it
  SketchVector point;  ///< where it stands
  SketchVector axis;   ///< its first axis
  bool has_errors;     ///< whether there are errors of the frame to the next joint, or the platform; of the first also
                       ///< those of the base
};

/// A mechanism as a picture shows it, at home.
struct Sketch {
  std::vector<std::vector<SketchedJoint>> limbs;  ///< base to platform
  SketchVector platform;                          ///< its origin, P
  std::vector<SketchVector> tool;                 ///< the tool's tip; none or one
};

}  // namespace poesy
