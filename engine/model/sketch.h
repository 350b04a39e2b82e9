#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace poesy {

/// A point (m) or a direction in the base frame, at one pose.
using SketchVector = std::array<double, 3>;

/// A joint in a picture.
struct SketchedJoint {
  std::string name;  ///< name in the mechanism's file; empty if it has none
  /// Type of joint: R (revolute), P (prismatic), H (helical), C (cylindrical), U (universal), S (spherical); F for a
  /// fixed frame.
  char type;
  bool actuated;       ///< true if a drive moves the joint
  SketchVector point;  ///< point of the joint: the origin of `frame` before the joint moves
  SketchVector axis;   ///< direction of the joint's first axis
  /// True if the frame behind this joint (that of the next joint, or of the platform) has errors; for the first joint
  /// also true if the joint itself or the base has errors.
  bool has_errors;
  /// Indices in the limb's list of Sketch::frames.
  /// @{
  std::size_t first = 1;  ///< frame of the joint's first axis, which gives the direction `axis`
  std::size_t frame = 1;  ///< frame whose origin is `point`; it may be that of a later axis of the joint
  /// @}
  std::string drive = {};  ///< name of the drive; empty if the joint has none
};

/// A frame of a limb: the frame of the base, of an axis of a joint (after the joint has moved), or of the platform.
struct SketchedFrame {
  SketchVector origin;  ///< origin, m
  /// Directions of the axes x, y and z; in the frame of a joint's axis, z is this axis.
  std::array<SketchVector, 3> axes;
};

/// A small motion of the platform as a twist [omega; v] at the base's origin (rad, m).
using SketchTwist = std::array<double, 6>;

/// The axis about which an error turns, or along which it displaces.
struct SketchedAxis {
  SketchedFrame frame;  ///< a frame whose z is the axis
  bool turns;           ///< true: rotation about the axis, perhaps with a displacement along it; false: displacement
};

/// An error in a picture. `after` and `before` count the joints of the limb from 1, from the base to the platform; 0
/// means the base, and the number after the last joint means the platform.
struct SketchedError {
  std::size_t limb;    ///< limb, counted from 0
  std::size_t frame;   ///< index of the error's frame in the limb's list of Sketch::frames
  std::size_t axis;    ///< axis of that frame: 0, 1 or 2
  bool turns;          ///< true: rotation about the axis; false: displacement along it
  std::size_t after;   ///< joint, or base, before the error
  std::size_t before;  ///< joint, or platform, after the error; equal to `after` for an error inside a joint
  /// [limbs] The first-order motion of each limb's end at the platform that the error causes, after the passive joints
  /// have adapted, per SI unit of the error. Only one motion if it is the same for all limbs. Empty if the passive
  /// joints are in a singular configuration.
  std::vector<SketchTwist> motions;
  /// The axis of the error, if it is known and is not an axis of `frame`, as for errors of features; otherwise none. It
  /// replaces `axis` and `turns`.
  std::optional<SketchedAxis> own = {};
};

/// A body at which limbs begin or end.
struct SketchedBody {
  std::string name;     ///< name in the mechanism's file
  SketchVector origin;  ///< origin of the body's frame
};

/// The bodies at the ends of a limb, as indices in Sketch::bodies.
struct SketchedEnds {
  std::size_t from = 0;  ///< body at which the limb begins; 0: the base
  std::size_t to = 1;    ///< body at which the limb ends; 1: the platform
};

/// A point of the platform with a name.
struct SketchedPoint {
  std::string name;    ///< name in the mechanism's file
  SketchVector point;  ///< position of the point
};

/// A feature of a part in a picture.
struct SketchedFeature {
  std::string name;   ///< name on the drawing, such as "rail"
  std::string zones;  ///< tolerances as text, such as "position 0.05 mm to A|B"; empty: none
  std::size_t limb;   ///< limb, counted from 0
  std::size_t frame;  ///< index of the part's frame in the limb's list of Sketch::frames
  /// Shape in the frame of the part (m): the ends of an axis, the corners of a plane in order, or one point.
  std::vector<SketchVector> outline;
};

/// The data for a picture of a mechanism at one pose.
struct Sketch {
  /// Joints of each limb, from the base to the platform or from one body to another.
  std::vector<std::vector<SketchedJoint>> limbs;
  SketchVector platform;           ///< origin P of the platform
  std::vector<SketchVector> tool;  ///< position of the tool's tip; empty if there is no tool
  /// [limbs] The frames of each limb: base, axes of the joints, platform. If errors_at_joints is set, the origins of
  /// the first and the last frame are at the first and the last joint, because angle errors of these frames turn about
  /// the joints.
  std::vector<std::vector<SketchedFrame>> frames = {};
  std::vector<SketchedError> errors = {};  ///< errors, in the order of ModelDescription::factors
  /// True if angle errors of a limb's first and last frames turn about the limb's first and last joints.
  bool errors_at_joints = false;
  bool z_is_down = false;  ///< true if the base's z axis points to the ground
  /// [limbs] bodies at the ends of each limb; empty: all limbs connect the base and the platform.
  std::vector<SketchedEnds> ends = {};
  std::vector<SketchedPoint> points = {};  ///< named points of the platform
  std::vector<SketchedBody> bodies = {};   ///< base, platform, and further bodies; empty if there are no further bodies
  std::vector<SketchedFeature> features = {};  ///< features of the drawing
  /// [limbs] The label of each limb in names of responses: "force_LABEL" is the force in the limb. Empty: there are no
  /// such responses.
  std::vector<std::string> labels = {};

  /// The bodies at the ends of a limb.
  SketchedEnds ends_of(std::size_t limb) const { return ends.empty() ? SketchedEnds{} : ends[limb]; }

  /// The frame of the platform. Only its axes may be used, because its origin may be at a joint. Null if no limb with
  /// frames ends at the platform.
  const SketchedFrame* platform_frame() const {
    for (std::size_t limb = 0; limb < frames.size(); ++limb) {
      if (ends_of(limb).to == 1 && !frames[limb].empty()) return &frames[limb].back();
    }
    return nullptr;
  }
};

}  // namespace poesy
