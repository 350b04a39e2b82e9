#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/model/feature.h"
#include "engine/model/model.h"
#include "engine/model/platform_points.h"
#include "models/assembly/assembly.h"
#include "models/chain/error_terms.h"
#include "models/chain/limb.h"
#include "models/file/mechanism_file.h"
#include "models/lie/se3.h"

/// The mechanism that a file describes, with numbers instead of expressions: SI, in the base frame, at the home pose.
namespace poesy::file {

/// A point (m) or a direction.
using Vector3 = lie::Vector3<double>;
/// A rigid motion, or the pose of a frame.
using Transform = lie::Transform<double>;

/// The motion of an elementary joint, about or along its z axis.
enum class Motion { fixed, revolute, prismatic, helical };

/// An elementary joint (a joint with one freedom), or a fixed frame. A joint of the file that has several freedoms
/// becomes several elementary joints.
struct Joint {
  std::string name;        ///< name of the joint in the file
  Place place;             ///< place of the joint in the file
  JointKind kind;          ///< type of the joint in the file
  Motion motion;           ///< motion; fixed: a frame with errors but without a displacement
  bool actuated;           ///< true if a drive holds the joint
  double pitch;            ///< pitch of a helical joint (m/rad); positive if right-handed
  Transform at_home;       ///< base_T_joint at home
  std::string drive = {};  ///< name of the drive, if the file gives one; joints with the same drive move together
  bool reaction = false;   ///< true if the reaction of the joint is a response

  /// Returns true if the joint has a displacement.
  bool moves() const { return motion != Motion::fixed; }
  /// The joint in the form that chain::Limb needs. A fixed frame is an actuated joint that does not move.
  chain::Joint of_chain() const;
};

/// Indices of the two bodies that every mechanism has.
/// @{
using assembly::kBase;
using assembly::kPlatform;
/// @}

/// A limb from one body to another, in local product-of-exponentials form as in chain::Limb.
struct Limb {
  std::vector<Joint> joints;    ///< joints, from the first body to the last
  std::vector<Transform> home;  ///< frames at home: body to first joint, joint to joint, last joint to body
  std::size_t from = kBase;     ///< index of the first body
  std::size_t to = kPlatform;   ///< index of the last body
  /// Label: the number of the limb, counted from 1; or the limb's name, with the number of the copy if there are
  /// several.
  std::string label = {};
  std::vector<assembly::Bearing> bearings = {};      ///< bearings with compliance
  std::vector<assembly::Link> links = {};            ///< links with compliance
  std::optional<assembly::Matrix6> compliance = {};  ///< compliance of the whole limb, in the frame of the last body

  /// Number of joints that have a displacement.
  std::size_t moving() const;
};

/// A drive of one actuated joint, or of several joints that it moves by the same displacement from home (rad or m).
struct Drive {
  std::string name;                 ///< name in the file, or the name of its joint's displacement
  std::vector<std::size_t> joints;  ///< indices among all joints that move, ascending

  /// Returns true if the drive moves several joints.
  bool is_shared() const { return joints.size() > 1; }
};

/// The pose of a body: x, y, z of its origin (P for the platform) in the base frame (m), then rx, ry, rz from home
/// (rad).
using PlatformPose = std::array<double, 6>;

/// A coordinate of poses.
struct Coordinate {
  std::string name;       ///< name in the file
  std::size_t component;  ///< index in PlatformPose
  double lower;           ///< lower limit of the workspace, SI
  double upper;           ///< upper limit of the workspace, SI

  /// The dimension: length or angle.
  Dimension dimension() const { return component < 3 ? Dimension::length : Dimension::angle; }
};

/// The precision of a mechanism whose numbers are exact.
/// @{
inline constexpr double kRankThreshold = 1e-6;  ///< a singular value below this share of the largest counts as zero
/// The largest opening (rad, or share of the reach) of a loop that counts as closed.
inline constexpr double kClosed = 1e-12;
/// @}

/// The precision of a mechanism's numbers, which rounding.h finds.
struct Precision {
  double rank_threshold = kRankThreshold;  ///< a singular value below this share of the largest counts as zero
  /// The largest opening (rad, or share of the reach) of a loop that counts as closed. If numbers are rounded, this is
  /// a bound on the response `gap` as a share of the reach; a pose is then the configuration with the least mismatch of
  /// the limbs, in the metric of the mechanism's points, and this mismatch remains.
  double closed = kClosed;

  /// Returns true if loops that stay open by more than kClosed count as closed.
  bool rounded() const { return closed > kClosed; }
};

/// An error that the file states with limb = "each".
struct EachLimb {
  /// Text for messages: name of the error, the limbs, and the two parts that its frame connects in each limb.
  std::string text;
  bool alike;  ///< true if the elementary joints of these limbs have the same motions in the same order
};

/// A mechanism in numbers. It contains everything that a model needs except solvers.
struct Mechanism {
  std::string name;                          ///< name in the file
  std::string title;                         ///< title in the file
  std::vector<assembly::Body> bodies = {};   ///< base, platform, then the other bodies, including copies
  std::vector<Limb> limbs = {};              ///< limbs, including copies
  Transform platform;                        ///< base_T_platform at home
  Rotation rotation;                         ///< meaning of rx, ry, rz of the platform
  std::vector<Coordinate> coordinates = {};  ///< pose coordinates, in the order of a pose's numbers
  Place coordinates_place;                   ///< place of the coordinates in the file
  std::optional<Vector3> tool = {};          ///< tool point in the platform's frame (m)
  /// Points of the platform that define the metric, in its frame (m); not all on a line.
  std::vector<Vector3> points = {};
  std::vector<Factor> factors = {};  ///< errors
  std::size_t first_named = 0;       ///< index of the first error with a table [[error]]; those follow all others
  std::vector<chain::ErrorTerms> terms = {};  ///< contributions of each error to components of frames' errors
  std::vector<FactorSet> sets = {};           ///< sets of errors, "all" first
  std::vector<EachLimb> each = {};            ///< for messages: tables [[error]] with limb = "each"
  ErrorsAbout about = ErrorsAbout::joint;     ///< points about which angular errors of frames rotate
  /// True if the solvers rotate angular errors of a limb's first and last frame about the joint next to the frame
  /// (chain::Limb::errors_at_joints). False if they rotate them about the origin of base or platform. With features it
  /// is always false; `terms` then contain the displacement of this origin if `about` is ErrorsAbout::joint.
  bool errors_at_joints = true;
  std::vector<Feature> features = {};  ///< features of all limbs
  /// [features] part_T_feature at home: the middle (m) and the axes of each feature in the frame of its part.
  std::vector<Transform> feature_places = {};
  /// The largest distance (m) between two points of joints, or between a joint and the platform's origin P. Copies of
  /// limbs do not count.
  double reach;
  Precision precision = {};  ///< precision of the numbers
  assembly::Load load = {};  ///< load, used only if there is stiffness
  /// Points of the platform, in its frame (m), whose displacements are reported.
  std::vector<NamedPlatformPoint> named = {};

  /// The number of joints that have a displacement, over all limbs.
  std::size_t moving() const;
  /// The number of independent loops.
  std::size_t loops() const { return limbs.size() - (bodies.size() - 1); }
  /// Returns true if there are bodies other than the base and the platform.
  bool is_branched() const { return bodies.size() > 2; }
  /// Returns true if any joint, link or limb has stiffness.
  bool is_elastic() const;
};

/// The default values of the parameters (SI), in the order of the file.
std::vector<double> default_geometry(const MechanismFile& file);

/// The mechanism for these values of file.geometry (SI). Throws InputError with the place in the file if these values
/// give no mechanism, for example because an expression has a wrong dimension, a direction has no length, or the two
/// axes of a universal joint are parallel.
Mechanism mechanism(const MechanismFile& file, std::span<const double> geometry);

/// The mechanism with lengths in units of its reach. The reach of the result is 1.
Mechanism in_reaches(Mechanism mechanism);

/// The names q_i_j of the displacements of all moving joints, limb by limb. The number i of the limb is counted from 1.
/// j is the number of the joint, counted from 1, among all joints and fixed frames of the limb.
std::vector<JointDisplacement> displacement_names(const Mechanism& mechanism);

/// A limb as text for messages: "limb 4", or with a name "limb 4 (left_1)". limb: index, counted from 0.
std::string limb_text(const Mechanism& mechanism, std::size_t limb);

/// The joints that have a displacement, limb by limb.
std::vector<const Joint*> moving_joints(const Mechanism& mechanism);

/// The drives of all limbs, in the order of each drive's first joint.
std::vector<Drive> drives_of(const Mechanism& mechanism);

/// The platform's frame base_T_platform at a pose: R = Rot(rx, ry, rz) R_home and P = (x, y, z).
Transform platform_transform(const Mechanism& mechanism, const PlatformPose& pose);

/// The frame base_T_body of a body other than the base at a pose. For the platform see platform_transform(). For other
/// bodies (rx, ry, rz) is the rotation vector.
Transform body_transform(const Mechanism& mechanism, std::size_t body, const PlatformPose& pose);

/// [6 x 6] The twists [omega; v] of the body, at the base's origin, per unit of each component of its pose (one in each
/// column).
lie::Matrix6<double> body_columns(const Mechanism& mechanism, std::size_t body, const PlatformPose& pose);

/// The pose of a body at home: its origin, and no rotation.
PlatformPose home_pose(const Mechanism& mechanism, std::size_t body);

/// For each body except the base, the index of a limb that ends there. In the order of this list the bodies can be
/// placed one after the other.
std::vector<std::size_t> placing_limbs(const Mechanism& mechanism);

/// The pose of the platform at home: P, and no rotation.
PlatformPose home_pose(const Mechanism& mechanism);

/// [6 x 6] The twists [omega; v] of the platform, at the base's origin, per unit of each component of its pose (one in
/// each column).
lie::Matrix6<double> platform_columns(const Mechanism& mechanism, const PlatformPose& pose);

/// The pose base_T_body of the body at the end of the limb. displacements: those of the limb's joints that move (rad,
/// m). from: pose of the body at which the limb begins. columns: null, or a matrix with a column for each of these
/// joints; receives the twists [omega; v] of the limb's end per unit of each displacement, at the base's origin.
Transform limb_transform(const Limb& limb, std::span<const double> displacements,
                         Eigen::Matrix<double, 6, Eigen::Dynamic>* columns = nullptr, const Transform& from = {});

}  // namespace poesy::file
