#pragma once

#include <vector>

#include "engine/model/model.h"
#include "engine/study/plan.h"

namespace poesy {

/// [responses] Model::rounding() of each response: the largest standard deviation (SI) that rounding alone may cause if
/// an error without effect varies.
std::vector<double> response_rounding(const Model& model);

/// [responses] For each response, the largest standard deviation (SI) that rounding alone may cause if all errors of
/// the plan vary together (stats/indices.h).
std::vector<double> joint_rounding(const Plan& plan, const Model& model);

}  // namespace poesy
