#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace poesy {

/// A point or a direction in the base frame (m), at one pose.
using SketchVector = std::array<double, 3>;

/// A joint as a picture shows it.
struct SketchedJoint {
  std::string name;    ///< as the mechanism's file has it; empty where it has none
  char type;           ///< R, P, H, C, U or S; F for a fixed frame
  bool actuated;       ///< a drive holds it
  SketchVector point;  ///< where it stands: the origin of `frame` before the joint moves
  SketchVector axis;   ///< its first axis
  bool has_errors;     ///< whether there are errors of the frame to the next joint, or the platform; of the first also
                       ///< those of the base
  std::size_t first = 1;   ///< of its limb's frames, the one of its first axis
  std::size_t frame = 1;   ///< of its limb's frames, the one at whose origin it stands
  std::string drive = {};  ///< name of the drive that holds it; empty where it has no name
};

/// A frame of a limb: of the base, of each axis of a joint after it has moved, of the platform.
struct SketchedFrame {
  SketchVector origin;               ///< m
  std::array<SketchVector, 3> axes;  ///< x, y and z; z is the joint's
};

/// A small motion of the platform, [omega; v] at the base's origin.
using SketchTwist = std::array<double, 6>;

/// What an error is in the picture. Joints count from 1, base to platform: 0 is the base, one more than there are
/// joints is the platform.
struct SketchedError {
  std::size_t limb;    ///< from 0
  std::size_t frame;   ///< of Sketch::frames, in which it is measured
  std::size_t axis;    ///< of that frame: 0, 1 or 2
  std::size_t after;   ///< the joint before it
  std::size_t before;  ///< the joint behind it; the same: it is inside that joint
  /// To first order, by which each limb moves the platform, once passive joints have given way, per SI unit of the
  /// error; one where all limbs move it alike. Empty where passive joints are in a singular configuration.
  std::vector<SketchTwist> motions;
};

/// A body between limbs.
struct SketchedBody {
  std::string name;     ///< as the mechanism's file has it
  SketchVector origin;  ///< of its frame
};

/// Between which bodies a limb is: positions among Sketch::bodies.
struct SketchedEnds {
  std::size_t from = 0;  ///< the base, or where it begins
  std::size_t to = 1;    ///< the platform, or where it ends
};

/// A mechanism as a picture shows it, at one pose.
struct Sketch {
  std::vector<std::vector<SketchedJoint>> limbs;  ///< base to platform, or from one body to another
  SketchVector platform;                          ///< its origin, P
  std::vector<SketchVector> tool;                 ///< the tool's tip; none or one
  /// Of each limb: the base, its joints' axes, the platform; with errors_at_joints the origins of base and platform are
  /// those of the first and the last joint, about which errors turn.
  std::vector<std::vector<SketchedFrame>> frames = {};
  std::vector<SketchedError> errors = {};  ///< [F], in the order of ModelDescription::factors
  bool errors_at_joints = false;           ///< whether angles of first and last frames turn there
  bool z_is_down = false;                  ///< whether the base's z axis points to the ground
  std::vector<SketchedEnds> ends = {};     ///< [limbs]; empty: all lead from the base to the platform
  std::vector<SketchedBody> bodies = {};   ///< base, platform, those between; empty where there are none between

  /// Of a limb.
  SketchedEnds ends_of(std::size_t limb) const { return ends.empty() ? SketchedEnds{} : ends[limb]; }
};

}  // namespace poesy
