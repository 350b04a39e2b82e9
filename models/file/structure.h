#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/model/sketch.h"
#include "models/file/mobility.h"

/// Texts that show how the program understood a mechanism file.
namespace poesy::file {

/// Text with a line for each elementary joint and fixed frame, with its frame at home (mm, in the base frame). Lines
/// about named points, bodies, limbs and drives follow, and the rules by which frames are chosen and errors act.
std::string structure_text(const Mechanism& mechanism);

/// The joints of a drive as text: "joint q of limb 1 and joint q of limb 4".
std::string joints_text(const Mechanism& mechanism, const Drive& drive);

/// A vector as text: "(0, 0.707107, 0.707107)".
std::string triple_text(const Vector3& value);

/// A small length as text: "0.12 um", or in mm if it is at least 0.01 mm.
std::string small_length_text(double metres);

/// The description of a coordinate.
std::string coordinate_text(const Coordinate& coordinate);

/// The sketch of the mechanism at home, with the features of its drawing. The sketch shows each joint as the file
/// states it; for example, a universal joint is one joint, although it consists of two elementary joints.
Sketch sketch_of(const Mechanism& mechanism);

/// Clauses about coordinates whose value at home is outside the workspace, one clause for each.
std::vector<std::string> home_outside(const Mechanism& mechanism);

/// A clause on a load that has no effect because nothing has stiffness. Empty if there is no such load.
std::vector<std::string> loads_without_effect(const Mechanism& mechanism);

/// A clause about a tool that is farther from the platform's origin than the mechanism's reach, or whose numbers may
/// have been stated in the base's frame, because read there they give a point near the platform's origin. At most one.
std::vector<std::string> odd_tool(const Mechanism& mechanism);

/// Clauses about coordinates of the workspace that turn the platform by more than a full turn, one clause for each.
std::vector<std::string> wide_turns(const Mechanism& mechanism);

/// A clause about the first universal joint whose axis on the leg's side is at less than 20 deg to the leg, at home.
/// The leg is the line to the next joint of type R, U or S, if this is U or S. Such an axis lets the leg swing about
/// one axis only. Universal joints at whose point another joint turns are left out. At most one clause, because the
/// copies of a limb share it.
std::vector<std::string> axes_along_legs(const Mechanism& mechanism);

/// Clauses about errors with limb = "each" whose limbs do not all have the same joint motions in the same order, one
/// clause for each such error.
std::vector<std::string> unlike_limbs(const Mechanism& mechanism);

/// A remark on the mismatch of perfect limbs with rounded numbers; empty if numbers are exact. mismatch: its largest
/// value, m.
std::vector<std::string> rounding_remarks(const Mechanism& mechanism, double mismatch);

/// Lines about the mobility at home: joints, ranks, freedoms, and the singular values just above and below the rank's
/// threshold. Then lines about the first poses of the workspace whose mobility differs from that at home, and about the
/// largest parasitic motion of the platform.
std::vector<std::string> mobility_lines(const Mechanism& mechanism, const Mobility& home,
                                        std::span<const PoseMobility> poses);

}  // namespace poesy::file
