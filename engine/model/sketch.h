#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace poesy {

/// A point or a direction in the base frame (m), at one pose.
using SketchVector = std::array<double, 3>;

/// A joint in a picture.
struct SketchedJoint {
  std::string name;    ///< name in the mechanism's file; empty if it has none
  char type;           ///< R, P, H, C, U or S; F for a fixed frame
  bool actuated;       ///< whether a drive moves it
  SketchVector point;  ///< its point: the origin of `frame` before the joint moves
  SketchVector axis;   ///< direction of its first axis
  bool has_errors;     ///< whether there are errors of the frame to the next joint, or the platform; of the first also
                       ///< those of the base
  std::size_t first = 1;   ///< position of the frame of its first axis, in the limb
  std::size_t frame = 1;   ///< position of the frame at whose origin it is, in the limb
  std::string drive = {};  ///< name of its drive; empty if it has none
};

/// A frame of a limb: of the base, of each axis of a joint after it has moved, of the platform.
struct SketchedFrame {
  SketchVector origin;               ///< origin, m
  std::array<SketchVector, 3> axes;  ///< x, y and z; z is the axis of the joint
};

/// A small motion of the platform, [omega; v] at the base's origin.
using SketchTwist = std::array<double, 6>;

/// An error in a picture. Joints count from 1, from the base to the platform: 0 is the base, and the number after the
/// last joint is the platform.
struct SketchedError {
  std::size_t limb;    ///< from 0
  std::size_t frame;   ///< position of its frame in Sketch::frames
  std::size_t axis;    ///< axis of that frame: 0, 1 or 2
  std::size_t after;   ///< preceding joint
  std::size_t before;  ///< following joint; equal to `after` for an error inside a joint
  /// The motions of the platform in each limb by the error, to first order, after passive joints have adapted, per SI
  /// unit of the error. One motion if it is the same in all limbs. Empty if passive joints are in a singular
  /// configuration.
  std::vector<SketchTwist> motions;
};

/// A body between limbs.
struct SketchedBody {
  std::string name;     ///< name in the mechanism's file
  SketchVector origin;  ///< origin of its frame
};

/// The bodies at the ends of a limb, as positions among Sketch::bodies.
struct SketchedEnds {
  std::size_t from = 0;  ///< body where the limb begins; 0: the base
  std::size_t to = 1;    ///< body where the limb ends; 1: the platform
};

/// A point of the platform with a name.
struct SketchedPoint {
  std::string name;    ///< name in the mechanism's file
  SketchVector point;  ///< its place
};

/// A feature of a part in a picture.
struct SketchedFeature {
  std::string name;   ///< name on the drawing: "rail"
  std::string zones;  ///< its tolerances for people: "position 0.05 mm to A|B"; empty: none
  std::size_t limb;   ///< from 0
  std::size_t frame;  ///< position, in Sketch::frames, of the frame of its part
  /// Its shape in that frame (m): the ends of an axis, the corners of a plane in their order, or one point.
  std::vector<SketchVector> outline;
};

/// A mechanism in a picture at one pose.
struct Sketch {
  std::vector<std::vector<SketchedJoint>>
      limbs;                       ///< joints of each limb, from the base to the platform or from one body to another
  SketchVector platform;           ///< origin of the platform, P
  std::vector<SketchVector> tool;  ///< the tool's tip; none or one
  /// The frames of each limb: base, axes of the joints, platform. With errors_at_joints, the origins of base and
  /// platform are those of the first and the last joint, about which errors turn.
  std::vector<std::vector<SketchedFrame>> frames = {};
  std::vector<SketchedError> errors = {};  ///< [F], in the order of ModelDescription::factors
  bool errors_at_joints = false;           ///< whether angles of the first and last frames turn about joints
  bool z_is_down = false;                  ///< whether the base's z axis points to the ground
  std::vector<SketchedEnds> ends = {};     ///< [limbs]; empty: all limbs connect the base and the platform
  std::vector<SketchedPoint> points = {};  ///< named points of the platform
  std::vector<SketchedBody> bodies = {};   ///< base, platform, and bodies between them; empty if there are none between
  std::vector<SketchedFeature> features = {};  ///< of the drawing

  /// The ends of a limb.
  SketchedEnds ends_of(std::size_t limb) const { return ends.empty() ? SketchedEnds{} : ends[limb]; }
};

}  // namespace poesy
