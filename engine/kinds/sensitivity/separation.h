#pragma once

#include <span>

#include "engine/kinds/sensitivity/result.h"
#include "engine/model/model.h"
#include "engine/run/result.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Separates these errors [P] at all poses. sigma: [P] their standard deviations, SI. An effect that is rounding has no
/// shares; over the poses, an effect that is not finite at one of them has none either.
/// Precondition: the model separates its errors and reaches the poses.
SeparationResult separate_errors(const Model& model, const PoseSet& poses, std::span<const FactorIndex> factors,
                                 std::span<const double> sigma);

}  // namespace poesy
