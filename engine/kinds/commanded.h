#pragma once

#include <span>
#include <vector>

#include "engine/calibration/drive_correction.h"
#include "engine/model/model.h"
#include "engine/result/result_file.h"
#include "engine/study/study.h"

namespace poesy {

/// Makes a function that computes, from the displacement of the platform, the errors of the coordinates that the
/// study's controller commands. Each coordinate is recognised by its values at test poses: they must be equal to a
/// component of the platform's position or to an angle of its rotation. Throws InputError if a coordinate is not
/// recognised, or if the drives do not fit: their number is not that of the pose coordinates, or the drives of one
/// motor do not move together.
calibration::CoordinateError commanded_coordinates(const Study& study, const Model& model,
                                                   const calibration::ExactMachine& machine, const PoseSet& poses);

/// The drives of a study, with their units: the first joint of each motor if the study names motors, otherwise the
/// drives of the model.
std::vector<NamedUnit> drives_of(const Study& study);

/// [drives] The displacement of each drive of the perfect mechanism at pose `drive_at`, minus that at `pose`. NaN for a
/// drive that moves several joints.
std::vector<double> drive_shift(const Model& model, const std::vector<NamedUnit>& drives, std::span<const double> pose,
                                std::span<const double> drive_at);

}  // namespace poesy
