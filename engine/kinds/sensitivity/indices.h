#pragma once

#include <optional>
#include <span>

#include "engine/kinds/sensitivity/cell_stats.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/result.h"
#include "engine/stats/moments.h"
#include "engine/stats/tolerance.h"
#include "engine/study/plan.h"

namespace poesy {

/// Each response to the background alone, all varied errors zero: one solve at each pose. NaN where it was not solved.
Array<double, axis::Response, axis::Pose> background_responses(const Plan& plan, const Model& model);

/// The global index of one factor for each response. at_poses: its cells. sigma: standard deviation of the
/// error.
std::vector<Estimate> global_indices(const CellStats& at_poses, double sigma, double conf_level);

/// The indices of a study from what its cells hold. cells: merged over the units of each (factor, pose); moved here
/// they take no memory beside the result's, because each response gives its own back. background, rounding: as
/// background_responses and response_rounding (run/response_rounding.h) give them.
SensitivityResult sensitivity_result(const Plan& plan, CellStats cells,
                                     Array<double, axis::Response, axis::Pose> background, std::vector<double> rounding,
                                     double conf_level);

/// Below which an index of an error of this standard deviation is rounding (stats/indices.h).
double index_rounding(const SensitivityResult& result, std::size_t response, double sigma);

/// One response of a result, for tolerances, by the published index. sigma: of the errors, as the study sets them.
/// Refers to both.
ResponseStudy response_study(const SensitivityResult& result, std::span<const double> sigma, std::size_t response);

/// The tolerances of one response, counted from this reference; without one those of equal effect are NaN.
Tolerances response_tolerances(const SensitivityResult& result, std::span<const double> sigma, std::size_t response,
                               const std::optional<ReferenceError>& reference);

}  // namespace poesy
