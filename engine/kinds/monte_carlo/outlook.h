#pragma once

#include "engine/run/outlook.h"

namespace poesy {

/// What a Monte Carlo study will ask of a machine: the solves, merging what each pose or unit comes to, and what is
/// read off at the end. Refers to the study, the model and the poses.
Outlook monte_carlo_outlook(const Study& study, const Model& model, const PoseSet& poses);

}  // namespace poesy
