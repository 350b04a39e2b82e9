#pragma once

#include <span>
#include <vector>

#include "engine/calibration/drive_correction.h"
#include "engine/model/model.h"
#include "engine/result/result_file.h"
#include "engine/study/study.h"

namespace poesy {

/// What the controller of a study commands: its coordinates as functions of the platform's place. They are recognised
/// by comparison with poses. Throws InputError if one is not recognised, or if drives do not match the coordinates.
calibration::CoordinateError commanded_coordinates(const Study& study, const Model& model,
                                                   const calibration::ExactMachine& machine, const PoseSet& poses);

/// The drives of a study: as the model names them, or those of its motors.
std::vector<NamedUnit> drives_of(const Study& study);

/// [drives] The displacements of the drives at one pose less those at another; NaN for a drive that moves several
/// joints.
std::vector<double> drive_shift(const Model& model, const std::vector<NamedUnit>& drives, std::span<const double> pose,
                                std::span<const double> drive_at);

}  // namespace poesy
