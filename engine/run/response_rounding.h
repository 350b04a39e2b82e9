#pragma once

#include <vector>

#include "engine/model/model.h"
#include "engine/study/plan.h"

namespace poesy {

/// [R] Model::rounding() of each response.
std::vector<double> response_rounding(const Model& model);

/// [R] The standard deviation up to which each response is rounding while all errors of the plan vary together
/// (stats/indices.h).
std::vector<double> joint_rounding(const Plan& plan, const Model& model);

}  // namespace poesy
