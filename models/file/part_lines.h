#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/schema/keys.h"
#include "models/file/lines.h"

/// Bodies, stiffness and loads of a mechanism file, as written.
namespace poesy::file {

/// A rigid body other than base and platform, as written.
struct BodyLines {
  std::string name;                ///< name of the body and its copies
  std::string key;                 ///< key in the file, for messages: "body[0]"
  Place place;                     ///< place of the table of the body in the file
  std::optional<Triple> at;        ///< origin at home
  std::optional<Triple> x;         ///< x axis at home; default: the base's x axis
  std::optional<Triple> z;         ///< z axis at home; given if and only if `x` is given
  Copies copies;                   ///< number of copies, and the axis of their rotation
  std::optional<Expression> mass;  ///< mass; default: 0
  std::optional<Triple> centre;    ///< centre of mass, in the body's frame; default: its origin
};

/// The stiffness of a joint's bearing and drive, as written. A direction without a value is rigid.
struct StiffnessLines {
  /// Stiffness along (x, y, z) and about (rx, ry, rz) the axes of the joint's first frame.
  /// @{
  std::optional<Expression> x, y, z;
  std::optional<Expression> rx, ry, rz;
  /// @}
  std::string key;  ///< key in the file, for messages
  Place place;      ///< place of the table of the stiffness in the file

  /// The entries in the order rx, ry, rz, x, y, z.
  std::array<const std::optional<Expression>*, 6> in_order() const { return {&rx, &ry, &rz, &x, &y, &z}; }
};

/// A compliance matrix of 6 x 6 numbers in SI, which maps [moment; force] to [rotation; translation].
struct ComplianceLines {
  std::array<double, 36> entries{};  ///< row by row
  std::string key;                   ///< key in the file, for messages
  Place place;                       ///< place of the list of entries in the file
};

/// A link between two joints, or between a body and a joint, as written.
struct LinkLines {
  std::string key;                     ///< key in the file, for messages: "limb[0].links[1]"
  Place place;                         ///< place of the table of the link in the file
  std::optional<Reference> from;       ///< a joint, or the body at which the limb begins
  std::optional<Reference> to;         ///< a joint, or the body at which the limb ends
  std::optional<Expression> E;         ///< Young's modulus
  std::optional<Expression> G;         ///< shear modulus
  std::optional<Expression> diameter;  ///< outer diameter of a round section
  std::optional<Expression> bore;      ///< inner diameter of a round section; default: 0
  std::optional<Expression> A;         ///< area of the section, if there is no diameter
  std::optional<Expression> Iy;        ///< second moment of area about y
  std::optional<Expression> Iz;        ///< second moment of area about z
  std::optional<Expression> J;         ///< torsion constant
  /// Shear correction factor of the area. Without it, shear deformation is neglected.
  std::optional<Expression> shear;
  std::optional<Triple> y;                    ///< y axis at home
  std::optional<ComplianceLines> compliance;  ///< compliance matrix, given instead of a section
};

/// The loads of a file, as written.
struct LoadLines {
  std::optional<Triple> gravity;  ///< gravity, an acceleration along base axes
  std::optional<Reference> body;  ///< body on which force and moment act; default: the platform
  std::optional<Triple> at;       ///< point of application, in the body's frame
  std::optional<Triple> force;    ///< force along base axes
  std::optional<Triple> moment;   ///< moment about base axes
};

std::vector<BodyLines> read_bodies(const StudyValue& value);  ///< Reads the list `[[body]]`.
StiffnessLines read_stiffness(const StudyValue& value);       ///< Reads `stiffness = { z = "60 N/um" }`.
std::vector<LinkLines> read_links(const StudyValue& value);   ///< Reads `links = [ ... ]`.
ComplianceLines read_compliance(const StudyValue& value);     ///< Reads `compliance = [ [ ... ], ... ]`.
LoadLines read_load(const StudyValue& value);                 ///< Reads the table `[load]`.

std::string load_text(const LoadLines& load);  ///< The keys of `[load]` as TOML, line by line.

/// The tables of bodies, stiffness and loads with all keys, for key_reference().
StudyTables part_tables();

}  // namespace poesy::file
