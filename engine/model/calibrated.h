#pragma once

#include <memory>
#include <string_view>

#include "engine/model/model.h"

namespace poesy {

/// A noun phrase for users that says what the responses of a study with `calibrated = true` are.
inline constexpr std::string_view kLeftByCalibration =
    "what remains with the drives corrected at each pose so that the platform's points (metric_points of a mechanism "
    "from a file) are best; for another point, such as the tool, a calibration can be better";

/// A model with the calibrated_evaluator() of the given model as its evaluator. Its responses are those that remain
/// after the correction of the actuators that is best for the platform's points (metric_points()). It has no trace,
/// because a trace shows uncorrected errors. Throws std::invalid_argument, whose text is a clause, if the given model
/// has no such evaluator.
std::unique_ptr<Model> calibrated(std::unique_ptr<Model> model);

}  // namespace poesy
