#pragma once

#include "engine/run/outlook.h"

namespace poesy::monte_carlo {

/// The expected cost of a Monte Carlo study: solving, merging poses or units, and computing the result. It keeps
/// references to the study, the model and the poses.
Outlook monte_carlo_outlook(const Study& study, const Model& model, const PoseSet& poses);

}  // namespace poesy::monte_carlo
