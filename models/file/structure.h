#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/model/sketch.h"
#include "models/file/mobility.h"

/// What was understood of a mechanism's file, for people.
namespace poesy::file {

/// Every elementary joint and fixed frame with its frame at home (mm, in the base frame), a line each, the drives that
/// have names, and the rule by which the frames were chosen.
std::string structure_text(const Mechanism& mechanism);

/// The joints that a drive moves: "joint q of limb 1 and joint q of limb 4".
std::string joints_text(const Mechanism& mechanism, const Drive& drive);

/// "(0, 0.707107, 0.707107)".
std::string triple_text(const Vector3& value);

/// A small length: "0.12 um", or in mm where it is no less than a hundredth of that.
std::string small_length_text(double metres);

/// What a coordinate is.
std::string coordinate_text(const Coordinate& coordinate);

/// The joints at home as the file has them: elementary ones that make one joint are one.
Sketch sketch_of(const Mechanism& mechanism);

/// Which coordinates of home are outside their workspace, a clause for each.
std::vector<std::string> home_outside(const Mechanism& mechanism);

/// Errors with limb = "each" of limbs that are not alike, a clause for each.
std::vector<std::string> unlike_limbs(const Mechanism& mechanism);

/// What rounded numbers leave between perfect limbs, mismatch m at the most; nothing where they are exact.
std::vector<std::string> rounding_remarks(const Mechanism& mechanism, double mismatch);

/// Joints, ranks and freedoms at home, the singular values around the gap, and what differs in the workspace: at the
/// first poses where something does.
std::vector<std::string> mobility_lines(const Mechanism& mechanism, const Mobility& home,
                                        std::span<const PoseMobility> poses);

}  // namespace poesy::file
