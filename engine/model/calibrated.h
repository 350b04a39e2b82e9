#pragma once

#include <memory>

#include "engine/model/model.h"

namespace poesy {

/// The same mechanism, whose outcomes are what the best correction of its actuators leaves: its evaluator is the
/// model's calibrated_evaluator(). It shows no trace, because a trace is of the errors alone; all else is the model's.
/// Throws std::invalid_argument with a clause where the model has no such evaluator.
std::unique_ptr<Model> calibrated(std::unique_ptr<Model> model);

}  // namespace poesy
