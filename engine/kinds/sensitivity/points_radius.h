#pragma once

#include <array>

#include "engine/kinds/sensitivity/result.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

/// Multiples of the distance of the platform's points from their middle at which the ranking is repeated.
inline constexpr std::array kPointsRadii{0.5, 2.0};

/// How much the ranking of a sensitivity study by the platform's metric depends on the choice of its points: Kendall's
/// tau between the errors' effects (index x sigma) with points at each of kPointsRadii and with the study's own.
/// Computed to first order, without the background's errors, at some of the poses (run/evaluate_unit.h). NaN if fewer
/// than two errors have an effect, and if the mechanism refuses points so far apart or so close. Empty if the mechanism
/// has no such metric. Precondition: a plan of a sensitivity study.
Array<double, axis::RadiusMultiple, axis::Response> radius_rank_correlations(const Study& study, const Plan& plan);

}  // namespace poesy
