#pragma once

#include <memory>
#include <string_view>

#include "engine/model/model.h"

namespace poesy {

/// Describes the responses of a calibrated study for people, as a noun phrase.
inline constexpr std::string_view kLeftByCalibration =
    "what the best correction of the actuators leaves, the best that any choice of drive offsets at each pose could "
    "do; no real calibration reaches that";

/// The same mechanism with responses that remain after the best correction of its actuators: its evaluator is the
/// model's calibrated_evaluator(). It has no trace, because a trace is of uncorrected errors; everything else is the
/// model's. Throws std::invalid_argument with a clause if the model has no such evaluator.
std::unique_ptr<Model> calibrated(std::unique_ptr<Model> model);

}  // namespace poesy
