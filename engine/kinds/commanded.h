#pragma once

#include <span>
#include <vector>

#include "engine/calibration/drive_correction.h"
#include "engine/model/model.h"
#include "engine/result/result_file.h"
#include "engine/study/study.h"

namespace poesy {

/// Makes a function that computes, from the displacement of the platform, the errors of the coordinates that the
/// study's controller commands. tip_x, tip_y and tip_z are coordinates of the tool point, unless the mechanism has pose
/// coordinates of these names. A pose coordinate is recognised by its values: they must equal a component of the
/// platform's position, or an angle of its rotation, at every test pose. Throws InputError if a coordinate is not
/// recognised, or if the drives do not match: their number differs from that of the pose coordinates, or the drives of
/// one motor do not move together.
calibration::CoordinateError commanded_coordinates(const Study& study, const Model& model,
                                                   const calibration::ExactMachine& machine, const PoseSet& poses);

/// The drives of a study, with their units. If the study names motors, each motor has the name and the unit of its
/// first joint; otherwise the drives are those of the model.
std::vector<NamedUnit> drives_of(const Study& study);

/// [drives] The displacement (rad or m) of each drive of the perfect mechanism at pose `drive_at`, minus its
/// displacement at `pose`. NaN for a drive that is not a single joint.
std::vector<double> drive_shift(const Model& model, const std::vector<NamedUnit>& drives, std::span<const double> pose,
                                std::span<const double> drive_at);

}  // namespace poesy
