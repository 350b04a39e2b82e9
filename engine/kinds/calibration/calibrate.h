#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/units.h"
#include "engine/kinds/calibration/result.h"
#include "engine/model/model.h"
#include "engine/study/machine_file.h"
#include "engine/study/study.h"

namespace poesy::calibration {

/// A parameter that an operator types into the controller. It is computed from the fitted errors.
struct TypedNumber {
  std::string name;     ///< name in the controller
  std::string text;     ///< expression that computes it
  Dimension dimension;  ///< length, angle or number
  /// The value of the parameter (SI) as a function of the values of the fitted errors (SI).
  std::function<double(std::span<const double> fitted)> value;
};

/// A machine to calibrate, and its measurements. The objects to which the members refer must outlive this one.
struct MachineToCalibrate {
  const Study& study;                     ///< the study, which has [analysis.calibration]
  const Model& model;                     ///< the model of its mechanism
  const std::string& path;                ///< path of the measurements, for messages
  const MachineFile& file;                ///< the table of measurements
  const PoseSet& measured_at;             ///< the pose of each row of the table of measurements
  const PoseSet& predicted_at;            ///< poses at which the remaining displacement is predicted
  const PoseSet& candidates;              ///< poses from which the next poses to measure are chosen
  const std::vector<TypedNumber>& typed;  ///< parameters of the controller to compute
  std::size_t threads = 1;                ///< number of threads; the result is the same for any number
};

/// The result of a calibration, and information on the fit for the user.
struct Calibrated {
  Result result;             ///< the result; the name, the text and the hash of the table of measurements are not set
  std::uint64_t solves = 0;  ///< how many times the mechanism was solved
  std::vector<std::string> warnings;  ///< warnings, as sentences for people
};

/// Fits the errors of [analysis.calibration] to the measurements. Throws InputError if they cannot be fitted, for
/// instance because the noise is not stated, there are too few measured values, or the drives do not match the
/// commanded coordinates.
Calibrated calibrate(const MachineToCalibrate& machine);

}  // namespace poesy::calibration
