#pragma once

#include <span>

#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/study/plan.h"

namespace poesy {

/// The indices of a study from what its cells hold. cells: [P x M], merged over the units of each (factor, pose).
SensitivityResult sensitivity_result(const Plan& plan, std::span<const UnitStats> cells, double conf_level);

}  // namespace poesy
