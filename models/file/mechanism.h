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

/// A mechanism of a file in numbers: SI, in the base frame, at home.
namespace poesy::file {

/// A point or a direction.
using Vector3 = lie::Vector3<double>;
/// A rigid motion.
using Transform = lie::Transform<double>;

/// The motion of an elementary joint, about or along its own z axis.
enum class Motion { fixed, revolute, prismatic, helical };

/// An elementary joint, or a fixed frame.
struct Joint {
  std::string name;        ///< of the joint to which it belongs
  Place place;             ///< of that joint in the file
  JointKind kind;          ///< of that joint
  Motion motion;           ///< fixed: a frame with errors and without a displacement
  bool actuated;           ///< whether a drive holds it
  double pitch;            ///< of a helical joint (m/rad); positive is right-handed
  Transform at_home;       ///< base_T_joint at home
  std::string drive = {};  ///< name of the drive, if the file gives one; joints of the same name move together
  bool reaction = false;   ///< whether the reaction of its joint is a response

  /// Whether it has a displacement.
  bool moves() const { return motion != Motion::fixed; }
  /// The joint as chain::Limb needs it; a fixed frame is an actuated joint that stays where it is.
  chain::Joint of_chain() const;
};

/// Positions of the two bodies that every mechanism has.
/// @{
using assembly::kBase;
using assembly::kPlatform;
/// @}

/// A limb in local product-of-exponentials form, as chain::Limb has it, from one body to another.
struct Limb {
  std::vector<Joint> joints;    ///< [n], from the first body to the last
  std::vector<Transform> home;  ///< [n + 1] at home: body to first joint, joint to joint, last joint to body
  std::size_t from = kBase;     ///< position of the first body
  std::size_t to = kPlatform;   ///< position of the last body
  std::string label = {};       ///< its number, counted from 1, or its name and the number of the copy
  std::vector<assembly::Bearing> bearings = {};      ///< bearings with compliance
  std::vector<assembly::Link> links = {};            ///< links with compliance
  std::optional<assembly::Matrix6> compliance = {};  ///< compliance of the whole limb, in the frame of the last body

  /// Number of joints that have a displacement.
  std::size_t moving() const;
};

/// A drive of one actuated joint, or of several that it moves by the same displacement from home (rad or m).
struct Drive {
  std::string name;                 ///< as in the file, or that of its joint's displacement
  std::vector<std::size_t> joints;  ///< positions among all joints that move, ascending

  /// Whether it moves several joints.
  bool is_shared() const { return joints.size() > 1; }
};

/// Pose of a body: x, y, z of its origin (of the platform: P) in the base frame (m), and rx, ry, rz from home (rad).
using PlatformPose = std::array<double, 6>;

/// A coordinate of a pose.
struct Coordinate {
  std::string name;       ///< as in the file
  std::size_t component;  ///< position in PlatformPose
  double lower;           ///< lower limit of the workspace
  double upper;           ///< upper limit of the workspace

  /// The dimension: length or angle.
  Dimension dimension() const { return component < 3 ? Dimension::length : Dimension::angle; }
};

/// Precision of exact numbers.
/// @{
inline constexpr double kRankThreshold = 1e-6;  ///< a singular value below this share of the largest counts as zero
inline constexpr double kClosed = 1e-12;  ///< a loop with a smaller opening is closed: rad, and shares of the reach
/// @}

/// The precision of a mechanism's numbers; rounding.h finds it.
struct Precision {
  double rank_threshold = kRankThreshold;  ///< a singular value below this share of the largest counts as zero
  /// Largest opening of a closed loop: rad, and shares of the reach. With rounded numbers it is the largest gap; a pose
  /// is then the one with the smallest mismatch of the limbs by the metric of the mechanism's points, and this mismatch
  /// remains.
  double closed = kClosed;

  /// Whether loops count as closed although they stay open by more than kClosed.
  bool rounded() const { return closed > kClosed; }
};

/// An error with limb = "each".
struct EachLimb {
  std::string text;  ///< its name, and the parts that it is between in each limb
  bool alike;        ///< whether these parts are the same in all limbs
};

/// A mechanism in numbers, immutable. Contains everything that a model needs except solvers.
struct Mechanism {
  std::string name;                           ///< as in the file
  std::string title;                          ///< as in the file
  std::vector<assembly::Body> bodies = {};    ///< base, platform, and the others, copies included
  std::vector<Limb> limbs = {};               ///< copies included
  Transform platform;                         ///< base_T_platform at home
  Rotation rotation;                          ///< meaning of rx, ry, rz
  std::vector<Coordinate> coordinates = {};   ///< in the order of a pose's numbers
  Place coordinates_place;                    ///< in the file
  std::optional<Vector3> tool = {};           ///< tool point in the platform's frame (m)
  std::vector<Vector3> points = {};           ///< of the metric, in the platform's frame (m); not all on a line
  std::vector<Factor> factors = {};           ///< [F]
  std::vector<chain::ErrorTerms> terms = {};  ///< [F] what each error adds to entries of frames' errors
  std::vector<FactorSet> sets = {};           ///< "all" first
  std::vector<EachLimb> each = {};            ///< the errors with limb = "each"
  ErrorsAbout about = ErrorsAbout::joint;     ///< of errors of frames, and of those with their own names
  bool errors_at_joints = true;               ///< see chain::Limb; false with features, whose errors are about frames
  std::vector<Feature> features = {};         ///< of all limbs
  /// [features] part_T_feature at home: the middle and the axes of each in the frame of its part (m).
  std::vector<Transform> feature_places = {};
  double reach;              ///< m: largest distance between the joints' points, before copies, and P
  Precision precision = {};  ///< of its numbers
  assembly::Load load = {};  ///< used if there is stiffness
  /// Points of the platform whose displacements are reported.
  std::vector<NamedPlatformPoint> named = {};

  /// Number of joints that have a displacement, over all limbs.
  std::size_t moving() const;
  /// Number of independent loops.
  std::size_t loops() const { return limbs.size() - (bodies.size() - 1); }
  /// Whether there are bodies other than base and platform.
  bool is_branched() const { return bodies.size() > 2; }
  /// Whether anything has stiffness.
  bool is_elastic() const;
};

/// The default values of the parameters (SI), in the order of the file.
std::vector<double> default_geometry(const MechanismFile& file);

/// The mechanism for these values of file.geometry, SI. Throws InputError with the place in the file if they give no
/// mechanism: wrong dimensions, directions without length, parallel axes that must not be parallel, metric points on a
/// line.
Mechanism mechanism(const MechanismFile& file, std::span<const double> geometry);

/// The same mechanism with lengths in units of its reach; its reach becomes 1.
Mechanism in_reaches(Mechanism mechanism);

/// The names q_i_j of the displacements of all moving joints, limb by limb: limbs i count from 1, j is the joint's
/// position, from 1, among all joints and fixed frames of the limb.
std::vector<JointDisplacement> displacement_names(const Mechanism& mechanism);

/// The limb's text for messages: "limb 4", or with a name "limb 4 (left_1)". limb: position, counts from 0.
std::string limb_text(const Mechanism& mechanism, std::size_t limb);

/// The joints that have a displacement, limb by limb.
std::vector<const Joint*> moving_joints(const Mechanism& mechanism);

/// The drives of all limbs, in the order of their first joints.
std::vector<Drive> drives_of(const Mechanism& mechanism);

/// base_T_platform of a pose: R = Rot(rx, ry, rz) R_home and P = (x, y, z).
Transform platform_transform(const Mechanism& mechanism, const PlatformPose& pose);

/// base_T_body of a body that is not the base. For the platform see platform_transform(); for others rx, ry, rz are the
/// rotation vector.
Transform body_transform(const Mechanism& mechanism, std::size_t body, const PlatformPose& pose);

/// The twists [omega; v] of the body, at the base's origin, per unit of each component of its pose: [6 x 6].
lie::Matrix6<double> body_columns(const Mechanism& mechanism, std::size_t body, const PlatformPose& pose);

/// The body's pose at home, without rotation.
PlatformPose home_pose(const Mechanism& mechanism, std::size_t body);

/// For each body except the base, a limb that ends there; in this order the bodies can be placed one after the other.
std::vector<std::size_t> placing_limbs(const Mechanism& mechanism);

/// The pose at home: P, and no rotation.
PlatformPose home_pose(const Mechanism& mechanism);

/// The twists [omega; v] of the platform, at the base's origin, per unit of each component of its pose: [6 x 6].
lie::Matrix6<double> platform_columns(const Mechanism& mechanism, const PlatformPose& pose);

/// Pose base_T_body of the body at the end of the limb for these displacements of its moving joints [moving] (rad, m).
/// from: the pose of the body where it begins. columns: null, or [6 x moving], set to the twists [omega; v] of its end
/// per unit of each displacement, at the base's origin.
Transform limb_transform(const Limb& limb, std::span<const double> displacements,
                         Eigen::Matrix<double, 6, Eigen::Dynamic>* columns = nullptr, const Transform& from = {});

}  // namespace poesy::file
