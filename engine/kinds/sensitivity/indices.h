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

/// The response to the background alone, with all varied errors at zero; NaN if it is not solved. It takes one solve at
/// each pose.
Array<double, axis::Response, axis::Pose> background_responses(const Plan& plan, const Model& model);

/// [responses] The global index of one error for each response. at_poses: the cells of the error. sigma: its standard
/// deviation, SI.
std::vector<Estimate> global_indices(const CellStats& at_poses, double sigma, double conf_level);

/// Computes the indices of a study. cells: statistics of each error and pose over all units. They are moved, and each
/// response's memory is freed when its indices are computed, so that cells and result are not in memory together.
/// background: see background_responses(); rounding: see response_rounding() (run/response_rounding.h).
SensitivityResult sensitivity_result(const Plan& plan, CellStats cells,
                                     Array<double, axis::Response, axis::Pose> background, std::vector<double> rounding,
                                     double conf_level);

/// The magnitude below which the index of an error with this standard deviation is rounding (stats/indices.h).
double index_rounding(const SensitivityResult& result, std::size_t response, double sigma);

/// The data of one response from which tolerances are set. Its indices are those of the published estimator. sigma:
/// [errors] standard deviations of the study's errors. error_mean: [errors] their means; empty if all are zero. Refers
/// to its arguments.
ResponseStudy response_study(const SensitivityResult& result, std::span<const double> sigma,
                             std::span<const double> error_mean, std::size_t response);

/// The tolerances of the errors for one response, relative to that of a reference error. Without a reference,
/// tolerances of equal effect are NaN.
Tolerances response_tolerances(const SensitivityResult& result, std::span<const double> sigma,
                               std::span<const double> error_mean, std::size_t response,
                               const std::optional<ReferenceError>& reference);

}  // namespace poesy
