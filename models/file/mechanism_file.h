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

/// A mechanism file as written: expressions, names and their places, without any number that depends on the geometry.
/// mechanism.h evaluates it.
namespace poesy::file {

/// The types of joints.
enum class JointKind { fixed, revolute, prismatic, helical, cylindrical, universal, spherical };
/// The name in the file: "fixed", "R", "P", "H", "C", "U", "S".
std::string_view name(JointKind kind);
char letter(JointKind kind);  ///< 'F', 'R', ...: the letter in sketches (SketchedJoint::type).
/// The number of elementary joints or fixed frames of this kind.
std::size_t elements(JointKind kind);

/// A joint as written.
struct JointLines {
  JointKind kind = JointKind::revolute;  ///< type of the joint
  std::string name;                      ///< unique in the limb
  std::string key;                       ///< for messages: "limb[0].joints[1]"
  Place place;                           ///< of its table
  std::optional<Triple> at;              ///< its point
  std::optional<Reference> at_point;     ///< its point, by name
  std::optional<Reference> from;         ///< point where its direction begins
  std::optional<Reference> to;           ///< point where its direction ends
  std::optional<Triple> axis;            ///< its direction, if from and to are absent
  std::optional<Triple> axis2;           ///< of U: the second axis
  std::optional<Triple> x;               ///< x axis of its first frame
  std::optional<Expression> pitch;       ///< of H, per turn
  std::array<bool, 2> actuated{};        ///< of each elementary joint
  std::optional<Reference> drive;        ///< the drive that holds it; "*" is replaced by the number of the limb's copy
  std::optional<StiffnessLines> stiffness;  ///< of its bearing and drive; none: rigid
  bool reaction = false;                    ///< whether its reaction is a response
};

/// A limb as written, with the number of its copies.
struct LimbLines {
  std::string name;                           ///< of the limb and its copies; empty: none
  std::string key;                            ///< for messages: "limb[0]"
  Place place;                                ///< of its table
  std::optional<Reference> from;              ///< the body where it begins; none: the base
  std::optional<Reference> to;                ///< the body where it ends; none: the platform
  std::vector<JointLines> joints;             ///< base to platform
  std::vector<NamedPoint> points;             ///< points of this limb alone
  Copies copies;                              ///< copies of the limb
  std::vector<LinkLines> links;               ///< links with compliance
  std::vector<FeatureLines> features;         ///< of its parts, with tolerances
  std::vector<ClearanceLines> clearances;     ///< of its joints
  std::optional<ComplianceLines> compliance;  ///< in the frame of the last body
};

/// A pose coordinate as written.
struct CoordinateLines {
  std::string name;       ///< "alpha"
  std::string component;  ///< "rx"
  std::string key;        ///< for messages
  Place place;            ///< of its name
  Expression lower;       ///< lower limit of the workspace
  Expression upper;       ///< upper limit of the workspace
};

/// The meaning of rx, ry, rz: the rotation of the platform from its home orientation.
enum class Rotation { vector, xyz, xzy, yxz, yzx, zxy, zyx };
/// "vector", or the order of the product of three rotations.
std::string_view name(Rotation rotation);

/// The platform as written.
struct PlatformLines {
  std::optional<Triple> origin;              ///< P at home
  std::optional<Triple> x;                   ///< its x axis at home; none: the base's
  std::optional<Triple> z;                   ///< given with x
  Rotation rotation = Rotation::vector;      ///< meaning of rx, ry, rz
  std::vector<CoordinateLines> coordinates;  ///< in the order of a pose's numbers
  Place coordinates_place;                   ///< of their list
  std::optional<Triple> tool;                ///< tool point in the platform's frame
  std::vector<NamedPoint> named;             ///< points whose displacements are reported, in the platform's frame
  std::vector<Triple> points;      ///< of the metric, in the platform's frame; none: derived from the ends of the limbs
  Place place;                     ///< of [platform] or its points
  std::optional<Expression> mass;  ///< none: 0
  std::optional<Triple> centre;    ///< of mass, in the platform's frame; none: its origin
};

/// The points about which angular errors of a limb's first and last frame turn. The axes are always those of base and
/// platform.
enum class ErrorsAbout {
  joint,  ///< the points of its first and of its last joint
  frame   ///< the origins of base and platform
};
/// "joint" or "frame".
std::string_view name(ErrorsAbout about);

/// A frame of some limbs, as `limb` and `frame` name it.
struct SlotLines {
  std::vector<std::size_t> limbs;  ///< limbs that have it, counted from 0
  bool each = false;               ///< whether the limbs are written as "each"
  /// [limbs] suffix of the name: the number of the limb or of its copy; 0: none.
  std::vector<std::size_t> numbers;
  std::vector<std::size_t> frames;  ///< [limbs] position of the frame in each limb, from 0
};

/// A component of a frame's error, and by how much an error changes it.
struct ComponentLines {
  std::size_t component;  ///< position in [epsilon; delta]
  Expression scale;       ///< per unit of the error
};

/// A place of an error that has several.
struct PlaceLines {
  SlotLines slot;                          ///< where it is
  std::vector<ComponentLines> components;  ///< what it changes there
};

/// A named error, `[[error]]`, as written.
struct ErrorLines {
  Reference name;                            ///< without the number of a limb
  SlotLines slot;                            ///< where it is, one error in each limb; without limbs: see places
  std::vector<std::size_t> components;       ///< positions in [epsilon; delta], each an error; none: see combination
  Expression scale{"1", "scale", {}, true};  ///< the entry of the frame's error is the error times this
  std::vector<ComponentLines> combination;   ///< components that are one error
  std::vector<PlaceLines> places;            ///< of one error
  std::optional<Reference> grows_with;       ///< joint of the limb with whose displacement it grows; none: it does not
  std::optional<Expression> from;            ///< displacement from home where it is zero; none: 0
  std::string description;                   ///< empty: the description of the frame
};

/// A factor set as written.
struct SetLines {
  Reference name;                   ///< of the set
  std::vector<Reference> patterns;  ///< names of errors, or patterns
};

/// A mechanism file in which everything that does not depend on values of the geometry has been checked.
struct MechanismFile {
  std::string path;                              ///< for messages
  std::string name;                              ///< of the mechanism
  std::string title;                             ///< text for people
  std::vector<GeometryParameter> geometry;       ///< in the order of the file, with defaults
  std::vector<NamedPoint> points;                ///< points for all limbs
  PlatformLines platform;                        ///< the platform
  std::vector<BodyLines> bodies;                 ///< bodies other than base and platform, without copies
  LoadLines load;                                ///< used if there is stiffness
  std::vector<LimbLines> limbs;                  ///< as written, without copies
  std::optional<std::vector<Reference>> frames;  ///< frame errors, by names and patterns; none: see all_frames()
  bool all = false;                              ///< whether `frames = "all"` is written
  ErrorsAbout about = ErrorsAbout::joint;        ///< of all errors
  std::vector<ErrorLines> errors;                ///< errors with their own names
  std::vector<SetLines> sets;                    ///< sets other than "all"
  GeneralLines general;                          ///< general tolerances of the drawing

  /// Whether a limb has features.
  bool has_features() const;
  /// Whether every entry of every fixed frame is an error: if the file says so, or if it names no error at all.
  bool all_frames() const { return all || (!frames && errors.empty() && !has_features()); }
};

/// The tables of a mechanism file with every key, for the reference.
const StudyTables& mechanism_file_tables();

/// Reads its responses of one's own for a model with this description; none if it has none. Throws InputError.
std::vector<OwnResponse> read_own_responses(const std::string& text, const std::string& path,
                                            const ModelDescription& model);

/// Reads a mechanism file of format version 1. path: for messages. Throws InputError "FILE:LINE:COL: ..." for any
/// mistake in the text or with the default geometry; a file that is returned also makes a Mechanism (mechanism.h).
MechanismFile read_mechanism_file(const std::string& text, const std::string& path);

}  // namespace poesy::file
