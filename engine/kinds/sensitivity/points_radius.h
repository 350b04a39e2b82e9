#pragma once

#include <array>

#include "engine/kinds/sensitivity/result.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy::sensitivity {

/// The ranking of errors is repeated with the points of the platform's metric moved to these multiples of their
/// distance from the middle of all points.
inline constexpr std::array kPointsRadii{0.5, 2.0};

/// How much the ranking of a sensitivity study by the platform's metric depends on the choice of the metric's points:
/// Kendall's tau between the errors' effects (index x sigma) with the points at each of kPointsRadii and with the
/// study's own points. Computed to first order, without the errors of the background, at some of the poses
/// (run/evaluate_unit.h). NaN if fewer than two errors have an effect, or if the mechanism refuses the moved points.
/// Empty if the mechanism has no metric with points, or no fidelity "first-order". Precondition: the plan is that of a
/// sensitivity study.
Array<double, axis::RadiusMultiple, axis::Response> radius_rank_correlations(const Study& study, const Plan& plan);

}  // namespace poesy::sensitivity
