#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"
#include "engine/model/model.h"
#include "engine/model/own_responses.h"
#include "engine/schema/keys.h"
#include "models/file/feature_lines.h"
#include "models/file/general.h"
#include "models/file/lines.h"
#include "models/file/part_lines.h"

/// A mechanism file as written: expressions, names and their places. No number here depends on the geometry;
/// mechanism.h evaluates the file.
namespace poesy::file {

/// The types of joints.
enum class JointKind { fixed, revolute, prismatic, helical, cylindrical, universal, spherical };
/// The name of a type of joint in files: "fixed", "R", "P", "H", "C", "U", "S".
std::string_view name(JointKind kind);
char letter(JointKind kind);  ///< The letter in sketches (SketchedJoint::type): 'F', 'R', ...
/// The number of elementary joints (joints with one freedom) of which a joint of this type consists; 1 for a fixed
/// frame.
std::size_t elements(JointKind kind);

/// A joint as written.
struct JointLines {
  JointKind kind = JointKind::revolute;     ///< type of the joint
  std::string name;                         ///< name, unique in the limb
  std::string key;                          ///< key in the file, for messages: "limb[0].joints[1]"
  Place place;                              ///< place of the table of the joint in the file
  std::optional<Triple> at;                 ///< point of the joint
  std::optional<Reference> at_point;        ///< point of the joint, as a named point
  std::optional<Reference> from;            ///< point at which the axis begins
  std::optional<Reference> to;              ///< point at which the axis ends
  std::optional<Triple> axis;               ///< direction of the axis; default: from `from` to `to`
  std::optional<Triple> axis2;              ///< second axis of a joint U
  std::optional<Triple> x;                  ///< x axis of the joint's first frame
  std::optional<Expression> pitch;          ///< pitch of a joint H, length per turn
  std::array<bool, 2> actuated{};           ///< true for each axis that a drive holds
  std::optional<Reference> drive;           ///< name of the drive; the number of the limb's copy replaces "*"
  std::optional<StiffnessLines> stiffness;  ///< stiffness of bearing and drive; none if they are rigid
  bool reaction = false;                    ///< true if the joint's reaction is a response
};

/// A limb as written, with its copies.
struct LimbLines {
  std::string name;                           ///< name of the limb and its copies; empty if there is none
  std::string key;                            ///< key in the file, for messages: "limb[0]"
  Place place;                                ///< place of the table of the limb in the file
  std::optional<Reference> from;              ///< body at which the limb begins; default: the base
  std::optional<Reference> to;                ///< body at which the limb ends; default: the platform
  std::vector<JointLines> joints;             ///< joints, in order from the first body to the last
  std::vector<NamedPoint> points;             ///< named points to which only this limb may refer
  Copies copies;                              ///< number of copies, and the axis of their rotation
  std::vector<LinkLines> links;               ///< links with compliance
  std::vector<FeatureLines> features;         ///< features of the limb's parts, with tolerances
  std::vector<ClearanceLines> clearances;     ///< clearances of the limb's joints
  std::optional<ComplianceLines> compliance;  ///< compliance of the whole limb, in the frame of the last body
};

/// A pose coordinate as written.
struct CoordinateLines {
  std::string name;       ///< name: "alpha"
  std::string component;  ///< component of the platform's pose: "rx"
  std::string key;        ///< key in the file, for messages
  Place place;            ///< place of the name in the file
  Expression lower;       ///< lower limit of the workspace
  Expression upper;       ///< upper limit of the workspace
};

/// The meaning of rx, ry, rz, which rotate the platform from its home orientation: the components of a rotation vector,
/// or the angles of three rotations about the base's axes. The letters then state the order of their product.
enum class Rotation { vector, xyz, xzy, yxz, yzx, zxy, zyx };
/// The name in files: "vector", or the order of the product, such as "xyz".
std::string_view name(Rotation rotation);

/// The platform as written.
struct PlatformLines {
  std::optional<Triple> origin;              ///< origin P at home
  std::optional<Triple> x;                   ///< x axis at home; default: the base's x axis
  std::optional<Triple> z;                   ///< z axis at home; given if and only if `x` is given
  Rotation rotation = Rotation::vector;      ///< meaning of rx, ry, rz
  std::vector<CoordinateLines> coordinates;  ///< pose coordinates, in the order of a pose's numbers
  Place coordinates_place;                   ///< place of the list of coordinates
  std::optional<Triple> tool;                ///< tool point in the platform's frame
  std::vector<NamedPoint> named;             ///< points whose displacements are reported, in the platform's frame
  /// Points of the metric, in the platform's frame; default: derived from the ends of the limbs.
  std::vector<Triple> points;
  Place place;                     ///< place of [platform], or of the metric's points if they are given
  std::optional<Expression> mass;  ///< mass; default: 0
  std::optional<Triple> centre;    ///< centre of mass, in the platform's frame; default: its origin
};

/// The centre about which an angular error of a limb's first or last frame rotates. The axes of rotation are always
/// those of base and platform.
enum class ErrorsAbout {
  joint,  ///< the point of the limb's first or last joint
  frame   ///< the origin of base or platform
};
/// The name in files: "joint" or "frame".
std::string_view name(ErrorsAbout about);

/// The frames on which an error acts: one or more limbs, and one frame in each of them, as the keys `limb` and `frame`
/// state them.
struct SlotLines {
  std::vector<std::size_t> limbs;  ///< indices of the limbs, counted from 0
  bool each = false;               ///< true if the file states limb = "each"
  /// [limbs] Suffix of the error's name: the number of the limb or of its copy; 0 if there is none.
  std::vector<std::size_t> numbers;
  std::vector<std::size_t> frames;  ///< [limbs] index of the frame in each limb, counted from 0
};

/// A component of a frame's error, and the change of the component by an error of the file.
struct ComponentLines {
  std::size_t component;  ///< index in [epsilon; delta]: 0-2 angular, 3-5 linear
  Expression scale;       ///< change of the component per unit of the error
};

/// One of several places in which an error acts.
struct PlaceLines {
  SlotLines slot;                          ///< limbs and frames in which the error acts
  std::vector<ComponentLines> components;  ///< components that the error changes there
};

/// A named error, `[[error]]`, as written.
struct ErrorLines {
  Reference name;  ///< name, without the number of a limb
  /// Limbs and frames in which the error acts. Each of these limbs has an error of its own. Empty if `places` are
  /// given.
  SlotLines slot;
  /// Indices in [epsilon; delta] of components, each of which is an error of its own; none if `combination` is given.
  std::vector<std::size_t> components;
  Expression scale{"1", "scale", {}, true};  ///< factor from the error to the component of the frame's error
  std::vector<ComponentLines> combination;   ///< components that form one error together
  std::vector<PlaceLines> places;            ///< the places, if the error acts in several places at once
  /// Joint of the limb to whose displacement the effect of the error is proportional; none if the effect is constant.
  std::optional<Reference> grows_with;
  std::optional<Expression> from;  ///< displacement of this joint from home at which the error is zero; default: 0
  std::string description;         ///< description; empty: a text about limb, frame and components is used
};

/// A factor set as written.
struct SetLines {
  Reference name;                   ///< name of the set
  std::vector<Reference> patterns;  ///< names of errors, or patterns of names
};

/// A mechanism file in which everything that does not depend on values of the geometry has been checked.
struct MechanismFile {
  std::string path;   ///< path of the file, for messages
  std::string name;   ///< name of the mechanism
  std::string title;  ///< title for people
  /// Parameters of the geometry, in the order of the file, with defaults.
  std::vector<GeometryParameter> geometry;
  std::vector<NamedPoint> points;                ///< named points to which all limbs may refer
  PlatformLines platform;                        ///< the platform
  std::vector<BodyLines> bodies;                 ///< bodies other than base and platform, each once as written; copies
                                                 ///< (BodyLines::copies) are not listed
  LoadLines load;                                ///< load, used only if there is stiffness
  std::vector<LimbLines> limbs;                  ///< limbs, each once as written; copies (LimbLines::copies) are not
                                                 ///< listed
  std::optional<std::vector<Reference>> frames;  ///< frame errors, by names and patterns; empty: see all_frames()
  bool all = false;                              ///< true if the file says `frames = "all"`
  ErrorsAbout about = ErrorsAbout::joint;        ///< centre of rotation of all angular errors of frames
  std::vector<ErrorLines> errors;                ///< errors with their own names
  std::vector<SetLines> sets;                    ///< sets of errors other than "all"
  GeneralLines general;                          ///< general tolerances of the drawing

  /// Returns true if any limb has features or clearances.
  bool has_features() const;
  /// Returns true if every component of every fixed frame is an error: if the file says so, or if it states neither
  /// errors nor features nor clearances.
  bool all_frames() const { return all || (!frames && errors.empty() && !has_features()); }
};

/// The tables of a mechanism file with all keys, for key_reference().
const StudyTables& mechanism_file_tables();

/// Reads the responses that a file defines itself ([[response]]), for a model with this description; none if it defines
/// none. Throws InputError for a mistake in them.
std::vector<OwnResponse> read_own_responses(const std::string& text, const std::string& path,
                                            const ModelDescription& model);

/// Reads a mechanism file of format version 1. path: for messages. Throws InputError "FILE:LINE:COL: ..." for a mistake
/// in the text, or if mechanism() refuses the default geometry. So mechanism() accepts every returned file with its
/// default geometry.
MechanismFile read_mechanism_file(const std::string& text, const std::string& path);

}  // namespace poesy::file
