#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/schema/keys.h"
#include "models/file/lines.h"

/// Bodies, stiffness and loads of a mechanism file, as they are written.
namespace poesy::file {

/// A rigid part besides base and platform, as written.
struct BodyLines {
  std::string name;                ///< of it and its copies
  std::string key;                 ///< for messages: "body[0]"
  Place place;                     ///< of its table
  std::optional<Triple> at;        ///< its origin at home
  std::optional<Triple> x;         ///< its x axis at home; none: the base's
  std::optional<Triple> z;         ///< given with x
  Copies copies;                   ///< how many
  std::optional<Expression> mass;  ///< none: 0
  std::optional<Triple> centre;    ///< of mass, in its frame; none: its origin
};

/// The stiffness of a joint's bearing and drive, as written; rigid in a direction that has none.
struct StiffnessLines {
  /// Along the axes of the joint's first frame, and about them.
  /// @{
  std::optional<Expression> x, y, z;
  std::optional<Expression> rx, ry, rz;
  /// @}
  std::string key;  ///< for messages
  Place place;      ///< of its table

  /// In the order rx, ry, rz, x, y, z.
  std::array<const std::optional<Expression>*, 6> in_order() const { return {&rx, &ry, &rz, &x, &y, &z}; }
};

/// A compliance, 6 x 6 bare SI numbers, [rotation; translation] from [moment; force].
struct ComplianceLines {
  std::array<double, 36> entries{};  ///< row by row
  std::string key;                   ///< for messages
  Place place;                       ///< of the list
};

/// A link between two joints, or a body and a joint, as written.
struct LinkLines {
  std::string key;                            ///< for messages: "limb[0].links[1]"
  Place place;                                ///< of its table
  std::optional<Reference> from;              ///< a joint, or the body where the limb begins
  std::optional<Reference> to;                ///< a joint, or the body where the limb ends
  std::optional<Expression> E;                ///< modulus of elasticity
  std::optional<Expression> G;                ///< shear modulus
  std::optional<Expression> diameter;         ///< of a round section
  std::optional<Expression> bore;             ///< its inner diameter; none: 0
  std::optional<Expression> A;                ///< area, where there is no diameter
  std::optional<Expression> Iy;               ///< area moment about y
  std::optional<Expression> Iz;               ///< about z
  std::optional<Expression> J;                ///< of torsion
  std::optional<Expression> shear;            ///< factor of the area that carries shear; none: no shear deformation
  std::optional<Triple> y;                    ///< its y axis at home
  std::optional<ComplianceLines> compliance;  ///< in the place of a section
};

/// Loads as written.
struct LoadLines {
  std::optional<Triple> gravity;  ///< acceleration, base axes
  std::optional<Reference> body;  ///< on whom force and moment act; none: the platform
  std::optional<Triple> at;       ///< where, in the body's frame
  std::optional<Triple> force;    ///< base axes
  std::optional<Triple> moment;   ///< base axes
};

std::vector<BodyLines> read_bodies(const StudyValue& value);  ///< `[[body]]`.
StiffnessLines read_stiffness(const StudyValue& value);       ///< `stiffness = { z = "60 N/um" }`.
std::vector<LinkLines> read_links(const StudyValue& value);   ///< `links = [ ... ]`.
ComplianceLines read_compliance(const StudyValue& value);     ///< `compliance = [ [ ... ], ... ]`.
LoadLines read_load(const StudyValue& value);                 ///< `[load]`.

std::string load_text(const LoadLines& load);  ///< The keys of `[load]` as TOML, line by line.

/// The tables of these with every key, for the reference.
StudyTables part_tables();

}  // namespace poesy::file
