#pragma once

#include <array>

#include "engine/kinds/sensitivity/result.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

/// Distances of the platform's points from their middle at which a ranking is made again, as multiples of the study's.
inline constexpr std::array kPointsRadii{0.5, 2.0};

/// What the ranking of a sensitivity study by the platform's metric owes to the choice of its points: Kendall's tau of
/// the errors' effects (index x sigma) between points at each of kPointsRadii and the study's own. To first order,
/// without the background's errors, and at some of the poses (run/evaluate_unit.h). NaN where fewer than two errors
/// have an effect, and where the mechanism refuses points so far apart or so close. Empty where the mechanism has no
/// such metric. Precondition: a plan of a sensitivity study.
Array<double, axis::RadiusMultiple, axis::Response> radius_rank_correlations(const Study& study, const Plan& plan);

}  // namespace poesy
