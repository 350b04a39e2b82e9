#pragma once

#include <vector>

#include "engine/model/model.h"
#include "engine/study/plan.h"

namespace poesy {

/// [R] Model::rounding() of each response: the magnitude of its rounding errors, SI.
std::vector<double> response_rounding(const Model& model);

/// [R] The standard deviation of each response up to which it may be rounding, if all errors of the plan vary together
/// (stats/indices.h).
std::vector<double> joint_rounding(const Plan& plan, const Model& model);

}  // namespace poesy
