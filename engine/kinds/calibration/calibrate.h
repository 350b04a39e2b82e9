#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/units.h"
#include "engine/kinds/calibration/result.h"
#include "engine/model/model.h"
#include "engine/study/machine_file.h"
#include "engine/study/study.h"

namespace poesy {

/// A number for the controller.
struct TypedNumber {
  std::string name;     ///< its name
  std::string text;     ///< the expression
  Dimension dimension;  ///< its dimension
  /// Its value (SI) for these fitted errors, SI.
  std::function<double(std::span<const double> fitted)> value;
};

/// A machine that is calibrated. Refers to all members.
struct MachineToCalibrate {
  const Study& study;                     ///< the study, with [analysis.calibration]
  const Model& model;                     ///< the model of its mechanism
  const std::string& path;                ///< path of the measurements, for messages
  const MachineFile& file;                ///< the measurements
  const PoseSet& measured_at;             ///< the poses of its rows
  const PoseSet& predicted_at;            ///< poses where what is left is predicted
  const PoseSet& candidates;              ///< poses from which the next ones are chosen
  const std::vector<TypedNumber>& typed;  ///< numbers for the controller
};

/// The result, and what to tell beside it.
struct Calibrated {
  CalibrationResult result;           ///< the result; text and hash of the file are not set
  bool converged = false;             ///< whether the fit converged
  std::vector<std::string> warnings;  ///< sentences for people
};

/// Fits the errors of [analysis.calibration] to the measurements. Throws InputError if the measurements cannot be
/// fitted: without their noise, fewer than what is fitted, or drives and commanded coordinates that do not match.
Calibrated calibrate(const MachineToCalibrate& machine);

}  // namespace poesy
