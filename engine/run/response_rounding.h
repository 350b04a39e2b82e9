#pragma once

#include <vector>

#include "engine/model/model.h"
#include "engine/study/plan.h"

namespace poesy {

/// Model::rounding of each response, [R].
std::vector<double> response_rounding(const Model& model);

/// Up to which standard deviation each response is rounding while all errors of the plan vary together, [R]
/// (stats/indices.h).
std::vector<double> joint_rounding(const Plan& plan, const Model& model);

}  // namespace poesy
