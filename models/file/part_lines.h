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
  std::string name;                ///< of the body and its copies
  std::string key;                 ///< for messages: "body[0]"
  Place place;                     ///< of its table
  std::optional<Triple> at;        ///< its origin at home
  std::optional<Triple> x;         ///< its x axis at home; none: the base's
  std::optional<Triple> z;         ///< given with x
  Copies copies;                   ///< copies of the body
  std::optional<Expression> mass;  ///< none: 0
  std::optional<Triple> centre;    ///< of mass, in the body's frame; none: its origin
};

/// The stiffness of a joint's bearing and drive, as written. Directions without a value are rigid.
struct StiffnessLines {
  /// Stiffness along the axes of the joint's first frame and about them.
  /// @{
  std::optional<Expression> x, y, z;
  std::optional<Expression> rx, ry, rz;
  /// @}
  std::string key;  ///< for messages
  Place place;      ///< of its table

  /// The entries in the order rx, ry, rz, x, y, z.
  std::array<const std::optional<Expression>*, 6> in_order() const { return {&rx, &ry, &rz, &x, &y, &z}; }
};

/// A compliance matrix, 6 x 6 numbers in SI, from [moment; force] to [rotation; translation].
struct ComplianceLines {
  std::array<double, 36> entries{};  ///< row by row
  std::string key;                   ///< for messages
  Place place;                       ///< of the list
};

/// A link between two joints, or between a body and a joint, as written.
struct LinkLines {
  std::string key;                            ///< for messages: "limb[0].links[1]"
  Place place;                                ///< of its table
  std::optional<Reference> from;              ///< a joint, or the first body of the limb
  std::optional<Reference> to;                ///< a joint, or the last body of the limb
  std::optional<Expression> E;                ///< Young's modulus
  std::optional<Expression> G;                ///< shear modulus
  std::optional<Expression> diameter;         ///< of a round section
  std::optional<Expression> bore;             ///< its inner diameter; none: 0
  std::optional<Expression> A;                ///< area, if there is no diameter
  std::optional<Expression> Iy;               ///< area moment about y
  std::optional<Expression> Iz;               ///< area moment about z
  std::optional<Expression> J;                ///< torsion constant
  std::optional<Expression> shear;            ///< shear correction factor of the area; none: no shear deformation
  std::optional<Triple> y;                    ///< its y axis at home
  std::optional<ComplianceLines> compliance;  ///< instead of a section
};

/// The loads of a file, as written.
struct LoadLines {
  std::optional<Triple> gravity;  ///< acceleration, along base axes
  std::optional<Reference> body;  ///< body on which force and moment act; none: the platform
  std::optional<Triple> at;       ///< point of application, in the body's frame
  std::optional<Triple> force;    ///< along base axes
  std::optional<Triple> moment;   ///< about base axes
};

std::vector<BodyLines> read_bodies(const StudyValue& value);  ///< Reads `[[body]]`.
StiffnessLines read_stiffness(const StudyValue& value);       ///< Reads `stiffness = { z = "60 N/um" }`.
std::vector<LinkLines> read_links(const StudyValue& value);   ///< Reads `links = [ ... ]`.
ComplianceLines read_compliance(const StudyValue& value);     ///< Reads `compliance = [ [ ... ], ... ]`.
LoadLines read_load(const StudyValue& value);                 ///< Reads `[load]`.

std::string load_text(const LoadLines& load);  ///< The keys of `[load]` as TOML, line by line.

/// The tables of this header with all keys, for the reference.
StudyTables part_tables();

}  // namespace poesy::file
