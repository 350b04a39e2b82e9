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

/// The response to the background alone, with all varied errors zero; NaN if not solved. It takes one solve at each
/// pose.
Array<double, axis::Response, axis::Pose> background_responses(const Plan& plan, const Model& model);

/// [R] The global index of one factor for each response. at_poses: the cells of the factor. sigma: the standard
/// deviation of the error.
std::vector<Estimate> global_indices(const CellStats& at_poses, double sigma, double conf_level);

/// Computes the indices of a study. cells: merged over the units of each (factor, pose). They are moved, and each
/// response frees its memory, so that they take no memory beside the result. background: see background_responses();
/// rounding: see response_rounding() (run/response_rounding.h).
SensitivityResult sensitivity_result(const Plan& plan, CellStats cells,
                                     Array<double, axis::Response, axis::Pose> background, std::vector<double> rounding,
                                     double conf_level);

/// The magnitude below which an index of an error of this standard deviation is rounding (stats/indices.h).
double index_rounding(const SensitivityResult& result, std::size_t response, double sigma);

/// The data of one response for tolerances, by the published index. sigma: [P] of the study's errors. error_mean: [P]
/// their means, empty if all are zero. Refers to its arguments.
ResponseStudy response_study(const SensitivityResult& result, std::span<const double> sigma,
                             std::span<const double> error_mean, std::size_t response);

/// The tolerances of one response, relative to this reference. Without a reference those of equal effect are NaN.
Tolerances response_tolerances(const SensitivityResult& result, std::span<const double> sigma,
                               std::span<const double> error_mean, std::size_t response,
                               const std::optional<ReferenceError>& reference);

}  // namespace poesy
