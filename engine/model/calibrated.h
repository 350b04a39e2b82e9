#pragma once

#include <memory>
#include <string_view>

#include "engine/model/model.h"

namespace poesy {

/// What responses of a calibrated study are, for people: a noun with what a reader must know of it.
inline constexpr std::string_view kLeftByCalibration =
    "what the best correction of the actuators leaves, the best that any choice of drive offsets at each pose could "
    "do; no real calibration reaches that";

/// The same mechanism, whose outcomes are what the best correction of its actuators leaves: its evaluator is the
/// model's calibrated_evaluator(). It shows no trace, because a trace is of the errors alone; all else is the model's.
/// Throws std::invalid_argument with a clause where the model has no such evaluator.
std::unique_ptr<Model> calibrated(std::unique_ptr<Model> model);

}  // namespace poesy
