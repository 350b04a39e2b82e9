#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/assembly.h"
#include "models/chain/limb.h"
#include "models/file/mechanism_file.h"
#include "models/lie/se3.h"

/// A mechanism of a file in numbers: SI, in the base frame, at home.
namespace poesy::file {

/// A point or a direction.
using Vector3 = lie::Vector3<double>;
/// A rigid motion.
using Transform = lie::Transform<double>;

/// What an elementary joint does, about or along its own z axis.
enum class Motion { fixed, revolute, prismatic, helical };

/// An elementary joint, or a fixed frame.
struct Joint {
  std::string name;        ///< of the joint that it belongs to
  Place place;             ///< of that joint in the file
  JointKind kind;          ///< of that joint
  Motion motion;           ///< fixed: it has a frame and errors, and no displacement
  bool actuated;           ///< a drive holds it
  double pitch;            ///< of a helical one, m/rad; positive is right-handed
  Transform at_home;       ///< base_T_joint at home
  std::string drive = {};  ///< name of the drive, where the file names it; joints of one name move together
  bool reaction = false;   ///< whether the reaction of the joint that it belongs to is a response

  /// Whether it has a displacement.
  bool moves() const { return motion != Motion::fixed; }
  /// As limbs of the solver have it; a fixed frame is a joint that a drive holds where it is.
  chain::Joint of_chain() const;
};

/// Positions of bodies that every mechanism has.
/// @{
using assembly::kBase;
using assembly::kPlatform;
/// @}

/// A limb in local product-of-exponentials form, as chain::Limb has it, from one body to another.
struct Limb {
  std::vector<Joint> joints;    ///< [n], in the order from the body where it begins to that where it ends
  std::vector<Transform> home;  ///< [n + 1]: body to first joint, joint to joint, last joint to body, at home
  std::size_t from = kBase;     ///< position of the body where it begins
  std::size_t to = kPlatform;   ///< position of the body where it ends
  std::string label = {};       ///< its number, counted from 1, or its name with that of the copy
  std::vector<assembly::Bearing> bearings = {};  ///< bearings with compliance
  std::vector<assembly::Link> links = {};        ///< links with compliance
  std::optional<assembly::Matrix6> compliance =
      {};  ///< compliance of the whole limb, in the frame of the body where it ends

  /// That have a displacement.
  std::size_t moving() const;
};

/// What moves one actuated joint, or several by the same displacement from home (rad or m).
struct Drive {
  std::string name;                 ///< as the file has it; of a drive without a name that of its joint's displacement
  std::vector<std::size_t> joints;  ///< places among all joints that move, ascending

  /// Whether it moves several joints.
  bool is_shared() const { return joints.size() > 1; }
};

/// x, y, z of P in the base frame (m), and rx, ry, rz from home (rad).
using PlatformPose = std::array<double, 6>;

/// A coordinate of a pose.
struct Coordinate {
  std::string name;       ///< as the file has it
  std::size_t component;  ///< of PlatformPose
  double lower;           ///< of the workspace
  double upper;           ///< likewise

  /// Length or angle.
  Dimension dimension() const { return component < 3 ? Dimension::length : Dimension::angle; }
};

/// Which entry of which fixed frame's error a factor adds to: entry += scale * factor.
struct ErrorSlot {
  std::size_t limb;       ///< counts from 0
  std::size_t frame;      ///< 0 .. joints of the limb
  std::size_t component;  ///< of [epsilon; delta]
  double scale;           ///< without unit
};

/// What holds where the numbers of a file are exact.
/// @{
inline constexpr double kRankThreshold = 1e-6;  ///< a singular value below this share of the largest counts as zero
inline constexpr double kClosed = 1e-12;        ///< up to which a loop counts as closed: rad, and shares of the reach
/// @}

/// How exactly a mechanism's numbers are taken; rounding.h finds it.
struct Precision {
  double rank_threshold = kRankThreshold;  ///< a singular value below this share of the largest counts as zero
  /// Up to which loops count as closed. Of rounded numbers the gap, as a share of the reach: a pose is then the one
  /// with the smallest mismatch of the limbs by the metric of the mechanism's points, and the mismatch stays in it.
  double closed = kClosed;

  /// Whether loops that stay open by more than kClosed may count as closed.
  bool rounded() const { return closed > kClosed; }
};

/// An error that is named once for each limb.
struct EachLimb {
  std::string text;  ///< its name, and between which parts it is in which limbs
  bool alike;        ///< whether these are the same parts in all limbs
};

/// Immutable. Everything that a model needs; solving is for others.
struct Mechanism {
  std::string name;                          ///< as the file has it
  std::string title;                         ///< likewise
  std::vector<assembly::Body> bodies = {};   ///< base, platform, and the others, copies included
  std::vector<Limb> limbs = {};              ///< copies included
  Transform platform;                        ///< base_T_platform at home
  Rotation rotation;                         ///< what rx, ry, rz mean
  std::vector<Coordinate> coordinates = {};  ///< in the order of a pose's numbers
  Place coordinates_place;                   ///< in the file
  std::optional<Vector3> tool = {};          ///< in the platform's frame
  std::vector<Vector3> points = {};          ///< of the metric, in the platform's frame; on no line
  std::vector<Factor> factors = {};          ///< [F]
  std::vector<ErrorSlot> slots = {};         ///< [F]
  std::vector<FactorSet> sets = {};          ///< "all" first
  std::vector<EachLimb> each = {};           ///< errors with limb = "each"
  bool errors_at_joints = true;              ///< see chain::Limb
  double reach;                              ///< m: the largest distance between joints' points, before copies, and P
  Precision precision = {};                  ///< of its numbers
  assembly::Load load = {};                  ///< acts where there is stiffness

  /// That have a displacement, of all limbs.
  std::size_t moving() const;
  /// Whether there are bodies besides base and platform.
  bool is_branched() const { return bodies.size() > 2; }
  /// Whether anything has stiffness.
  bool is_elastic() const;
};

/// The parameters' defaults, in the order of the file.
std::vector<double> default_geometry(const MechanismFile& file);

/// The mechanism with these values of file.geometry, SI. Throws InputError with the place in the file where they make
/// no mechanism: wrong dimensions, directions without length, axes that are parallel where they must not be, metric
/// points on a line.
Mechanism mechanism(const MechanismFile& file, std::span<const double> geometry);

/// The same mechanism with lengths in units of its reach, whose reach is 1.
Mechanism in_reaches(Mechanism mechanism);

/// The displacements q_i_j of all joints that move, limb by limb: limbs count from 1, j is the joint's place among all
/// joints and fixed frames of the limb.
std::vector<JointDisplacement> displacement_names(const Mechanism& mechanism);

/// "limb 4", with a name "limb 4 (left_1)", for messages. limb: position, counts from 0.
std::string limb_text(const Mechanism& mechanism, std::size_t limb);

/// The joints that have a displacement, limb by limb.
std::vector<const Joint*> moving_joints(const Mechanism& mechanism);

/// The drives of all limbs, in the order of their first joints.
std::vector<Drive> drives_of(const Mechanism& mechanism);

/// base_T_platform for R = Rot(rx, ry, rz) R_home and P = (x, y, z).
Transform platform_transform(const Mechanism& mechanism, const PlatformPose& pose);

/// base_T_body of a body that is not the base. Of the platform as above; of others rx, ry, rz are the rotation vector.
Transform body_transform(const Mechanism& mechanism, std::size_t body, const PlatformPose& pose);

/// Twist [omega; v] of the body, at the base's origin, by each component of its pose: [6 x 6].
lie::Matrix6<double> body_columns(const Mechanism& mechanism, std::size_t body, const PlatformPose& pose);

/// The body's pose at home, without rotation.
PlatformPose home_pose(const Mechanism& mechanism, std::size_t body);

/// The limbs by which bodies can be placed one after the other: of each body but the base one that ends there.
std::vector<std::size_t> placing_limbs(const Mechanism& mechanism);

/// The pose at home: P, and no rotation.
PlatformPose home_pose(const Mechanism& mechanism);

/// Twist [omega; v] of the platform, at the base's origin, by each component of its pose: [6 x 6].
lie::Matrix6<double> platform_columns(const Mechanism& mechanism, const PlatformPose& pose);

/// Pose of the body where the limb ends by its moving joints [moving], where the body at which it begins is at `from`.
/// columns: null, or [6 x moving], set to the twists of its end, at the base's origin, by each of them.
Transform limb_transform(const Limb& limb, std::span<const double> displacements,
                         Eigen::Matrix<double, 6, Eigen::Dynamic>* columns = nullptr, const Transform& from = {});

}  // namespace poesy::file
