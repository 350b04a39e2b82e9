#pragma once

#include <vector>

#include "engine/model/model.h"
#include "engine/study/plan.h"

namespace poesy {

/// [responses] Model::rounding() of each response: the magnitude of its rounding errors, SI.
std::vector<double> response_rounding(const Model& model);

/// [responses] If all errors of the plan vary together, a standard deviation of a response up to this number may be
/// rounding alone (stats/indices.h).
std::vector<double> joint_rounding(const Plan& plan, const Model& model);

}  // namespace poesy
