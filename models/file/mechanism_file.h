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
#include "engine/schema/keys.h"
#include "models/file/lines.h"
#include "models/file/part_lines.h"

/// A mechanism file as it is written: expressions, names and their places, without any number that depends on the
/// geometry. mechanism.h makes numbers of it.
namespace poesy::file {

/// The types of joints.
enum class JointKind { fixed, revolute, prismatic, helical, cylindrical, universal, spherical };
/// "fixed", "R", "P", "H", "C", "U", "S".
std::string_view name(JointKind kind);
char letter(JointKind kind);  ///< 'F', 'R', ..., by which sketches know it (SketchedJoint::type).
/// Of how many elementary joints or fixed frames it consists.
std::size_t elements(JointKind kind);

/// A joint as written.
struct JointLines {
  JointKind kind = JointKind::revolute;     ///< what it is
  std::string name;                         ///< unique in the limb
  std::string key;                          ///< for messages: "limb[0].joints[1]"
  Place place;                              ///< of its table
  std::optional<Triple> at;                 ///< where it stands
  std::optional<Reference> at_point;        ///< or the point where it stands
  std::optional<Reference> from;            ///< its direction begins here
  std::optional<Reference> to;              ///< and points here
  std::optional<Triple> axis;               ///< its direction, without from and to
  std::optional<Triple> axis2;              ///< of U: the second
  std::optional<Triple> x;                  ///< of its first frame
  std::optional<Expression> pitch;          ///< of H, per turn
  std::array<bool, 2> actuated{};           ///< its elementary joints
  std::optional<Reference> drive;           ///< that holds it and others; "*" in it: the number of the limb's copy
  std::optional<StiffnessLines> stiffness;  ///< of its bearing and drive; none: rigid
  bool reaction = false;                    ///< whether its reaction is a response
};

/// A limb as written, and how often.
struct LimbLines {
  std::string name;                           ///< of it and its copies; empty: none
  std::string key;                            ///< for messages: "limb[0]"
  Place place;                                ///< of its table
  std::optional<Reference> from;              ///< the body where it begins; none: the base
  std::optional<Reference> to;                ///< the body where it ends; none: the platform
  std::vector<JointLines> joints;             ///< base to platform
  std::vector<NamedPoint> points;             ///< its own
  Copies copies;                              ///< how many
  std::vector<LinkLines> links;               ///< that give way
  std::optional<ComplianceLines> compliance;  ///< in the frame of the body where it ends
};

/// A pose coordinate as written.
struct CoordinateLines {
  std::string name;       ///< "alpha"
  std::string component;  ///< "rx"
  std::string key;        ///< for messages
  Place place;            ///< of its name
  Expression lower;       ///< of the workspace
  Expression upper;       ///< likewise
};

/// How rx, ry, rz turn the platform from its home orientation.
enum class Rotation { vector, xyz, xzy, yxz, yzx, zxy, zyx };
/// "vector", or the order of a product of three rotations.
std::string_view name(Rotation rotation);

/// The platform as written.
struct PlatformLines {
  std::optional<Triple> origin;              ///< P at home
  std::optional<Triple> x;                   ///< its x axis at home; none: the base's
  std::optional<Triple> z;                   ///< given with x
  Rotation rotation = Rotation::vector;      ///< what rx, ry, rz mean
  std::vector<CoordinateLines> coordinates;  ///< in the order of a pose's numbers
  Place coordinates_place;                   ///< of their list
  std::optional<Triple> tool;                ///< a point of the platform, in its frame
  std::vector<Triple> points;                ///< of the metric, in the platform's frame; none: by the limbs' ends
  Place place;                               ///< of [platform] or its points
  std::optional<Expression> mass;            ///< none: 0
  std::optional<Triple> centre;              ///< of mass, in its frame; none: its origin
};

/// About what an angle of a limb's first and of its last frame turns; the axes are the base's and the platform's.
enum class ErrorsAbout {
  joint,  ///< the points of its first and of its last joint
  frame   ///< the origins of base and platform
};
/// "joint" or "frame".
std::string_view name(ErrorsAbout about);

/// An error that a mechanism file names, `[[error]]`.
struct ErrorLines {
  Reference name;                  ///< without numbers
  std::vector<std::size_t> limbs;  ///< that have it, counted from 0
  bool each = false;               ///< whether they are meant by "each"
  /// [limbs] what is appended to the name: the limb's number, or that of its copy; 0: nothing.
  std::vector<std::size_t> numbers;
  std::vector<std::size_t> frames;           ///< [limbs] of each, counts from 0
  std::vector<std::size_t> components;       ///< of [epsilon; delta]
  Expression scale{"1", "scale", {}, true};  ///< the entry of the frame's error is the error times this
  std::string description;                   ///< empty: the frame's
};

/// A factor set as written.
struct SetLines {
  Reference name;                   ///< of the set
  std::vector<Reference> patterns;  ///< names or patterns of errors
};

/// A mechanism file: everything that does not depend on values of the geometry is checked.
struct MechanismFile {
  std::string path;                              ///< for messages
  std::string name;                              ///< of the mechanism
  std::string title;                             ///< for people
  std::vector<GeometryParameter> geometry;       ///< in the order of the file, with defaults
  std::vector<NamedPoint> points;                ///< of all limbs
  PlatformLines platform;                        ///< what the limbs hold
  std::vector<BodyLines> bodies;                 ///< besides base and platform, without copies
  LoadLines load;                                ///< that act where there is stiffness
  std::vector<LimbLines> limbs;                  ///< as written, without copies
  std::optional<std::vector<Reference>> frames;  ///< frame errors: names and patterns; none: see all_frames()
  bool all = false;                              ///< whether `frames = "all"` is written
  ErrorsAbout about = ErrorsAbout::joint;        ///< of all errors
  std::vector<ErrorLines> errors;                ///< with names of their own
  std::vector<SetLines> sets;                    ///< besides "all"

  /// Whether every entry of every fixed frame is an error: as written, or where no error is named at all.
  bool all_frames() const { return all || (!frames && errors.empty()); }
};

/// The tables of a mechanism file with every key, for the reference.
const StudyTables& mechanism_file_tables();

/// Reads a mechanism file of format version 1. `path` is for messages. Throws InputError "FILE:LINE:COL: ..." for
/// whatever is wrong in the text or with its default geometry: the file then also makes a Mechanism (mechanism.h).
MechanismFile read_mechanism_file(const std::string& text, const std::string& path);

}  // namespace poesy::file
