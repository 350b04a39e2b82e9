#pragma once

#include <cstddef>
#include <vector>

#include "engine/study/plan.h"

namespace poesy {

/// The numbers of samples of a cell at which a sensitivity study with a fixed number of samples looks at its indices,
/// ascending: 100, 200, 500, 1000, 2000, 5000, ... up to Plan::samples(), which is one of them only by chance. More
/// samples only add to the list. Those above Plan::kUnitSamples are whole units. None where the samples are adaptive.
std::vector<std::size_t> history_points(const Plan& plan);

}  // namespace poesy
