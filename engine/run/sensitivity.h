#pragma once

#include <span>

#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/stats/interval.h"
#include "engine/stats/tolerance.h"
#include "engine/study/plan.h"

namespace poesy {

/// Each response to the background alone, all varied errors zero: one solve at each pose, [R x M]. NaN where it was not
/// solved.
std::vector<double> background_responses(const Plan& plan, const Model& model);

/// The global index of one factor for each response, [R]. at_poses: [M], its cells. sigma: standard deviation of the
/// error.
std::vector<Estimate> global_indices(std::span<const UnitStats> at_poses, double sigma, double conf_level);

/// The indices of a study from what its cells hold. cells: [P x M], merged over the units of each (factor, pose).
/// background: as background_responses gives it.
SensitivityResult sensitivity_result(const Plan& plan, std::span<const UnitStats> cells, std::vector<double> background,
                                     double conf_level);

/// One response of a result, for tolerances. sigma: [P] of the errors, as the study sets them. Refers to both.
ResponseStudy response_study(const SensitivityResult& result, std::span<const double> sigma, std::size_t response);

}  // namespace poesy
