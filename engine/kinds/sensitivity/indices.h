#pragma once

#include <optional>
#include <span>

#include "engine/kinds/sensitivity/cell_stats.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/result.h"
#include "engine/stats/indices.h"
#include "engine/stats/moments.h"
#include "engine/stats/tolerance.h"
#include "engine/study/plan.h"

namespace poesy::sensitivity {

/// The responses to the background alone, with all varied errors at zero, SI; NaN if the pose is not solved. Takes one
/// solve at each pose.
Array<double, axis::Response, axis::Pose> background_responses(const Plan& plan, const Model& model);

/// [responses] The global index of one error for each response. at_poses: [poses] statistics of the samples of this
/// error. sigma: standard deviation of the error, SI.
std::vector<Estimate> global_indices(const CellStats& at_poses, double sigma, double conf_level);

/// Computes the indices of a study. cells: statistics of each error at each pose, over all samples. The memory of each
/// response in `cells` is freed when its indices are computed, so that cells and result are never both in memory as a
/// whole. background: see background_responses(). rounding: see response_rounding() (run/response_rounding.h).
Result sensitivity_result(const Plan& plan, CellStats cells, Array<double, axis::Response, axis::Pose> background,
                          std::vector<double> rounding, double conf_level);

using poesy::index_rounding;  // takes only numbers; the next function would hide it

/// The magnitude below which the index of an error is rounding (stats/indices.h). sigma: standard deviation of the
/// error. All numbers are SI.
double index_rounding(const Result& result, std::size_t response, double sigma);

/// The data of one response from which tolerances are set. The indices are those of the published estimator. sigma:
/// [errors] standard deviations of the errors in the study, SI. error_mean: [errors] means of the errors, SI; empty if
/// all are zero. The result refers to the arguments.
ResponseStudy response_study(const Result& result, std::span<const double> sigma, std::span<const double> error_mean,
                             std::size_t response);

/// The tolerances of the errors for one response, relative to the tolerance of a reference error. Without a reference,
/// tolerances of equal effect are NaN. sigma, error_mean: see response_study().
Tolerances response_tolerances(const Result& result, std::span<const double> sigma, std::span<const double> error_mean,
                               std::size_t response, const std::optional<ReferenceError>& reference);

}  // namespace poesy::sensitivity
