#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/model/sketch.h"
#include "models/file/mobility.h"

/// Texts that show how a mechanism file was understood.
namespace poesy::file {

/// A line for each elementary joint and fixed frame with its frame at home (mm, in the base frame), the named drives,
/// and the rule that chose the frames.
std::string structure_text(const Mechanism& mechanism);

/// The joints of a drive: "joint q of limb 1 and joint q of limb 4".
std::string joints_text(const Mechanism& mechanism, const Drive& drive);

/// A vector as text: "(0, 0.707107, 0.707107)".
std::string triple_text(const Vector3& value);

/// A small length as text: "0.12 um", or in mm from 0.01 mm on.
std::string small_length_text(double metres);

/// The description of a coordinate.
std::string coordinate_text(const Coordinate& coordinate);

/// The sketch of the joints at home, as written in the file: elementary joints of one joint are shown as one. With the
/// features of the drawing.
Sketch sketch_of(const Mechanism& mechanism);

/// A clause for each coordinate of home that is outside its workspace.
std::vector<std::string> home_outside(const Mechanism& mechanism);

/// A clause for each error with limb = "each" whose limbs are not alike.
std::vector<std::string> unlike_limbs(const Mechanism& mechanism);

/// A remark on the mismatch of perfect limbs with rounded numbers (mismatch: its largest value, m); empty if they are
/// exact.
std::vector<std::string> rounding_remarks(const Mechanism& mechanism, double mismatch);

/// Lines on joints, ranks and freedoms at home, the singular values around the gap, and the differences at the first
/// poses of the workspace that differ.
std::vector<std::string> mobility_lines(const Mechanism& mechanism, const Mobility& home,
                                        std::span<const PoseMobility> poses);

}  // namespace poesy::file
