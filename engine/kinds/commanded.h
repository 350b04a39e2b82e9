#pragma once

#include <span>
#include <vector>

#include "engine/calibration/drive_correction.h"
#include "engine/model/model.h"
#include "engine/result/result_file.h"
#include "engine/study/study.h"

namespace poesy {

/// The coordinates that the controller of a study commands, as functions of the platform's placement. Each is
/// recognised by comparison with placements at test poses. Throws InputError if a coordinate is not recognised, or if
/// the number of drives differs from the number of coordinates.
calibration::CoordinateError commanded_coordinates(const Study& study, const Model& model,
                                                   const calibration::ExactMachine& machine, const PoseSet& poses);

/// The drives of a study, with their units: the first joint of each motor if the study names motors, otherwise the
/// drives of the model.
std::vector<NamedUnit> drives_of(const Study& study);

/// [drives] The displacement of each drive at `drive_at` minus that at `pose`. NaN for a drive that moves several
/// joints.
std::vector<double> drive_shift(const Model& model, const std::vector<NamedUnit>& drives, std::span<const double> pose,
                                std::span<const double> drive_at);

}  // namespace poesy
