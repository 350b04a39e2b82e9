#pragma once

#include <optional>

#include "engine/kinds/identification/identification.h"
#include "engine/kinds/kind.h"
#include "engine/run/run_options.h"

namespace poesy {

/// Identifies which of the study's errors deform the mechanism, see identify(). Empty when stopped.
std::optional<IdentificationResult> run_identification(const Study& study, const Model& model, const PoseSet& poses,
                                                       const RunOptions& options);

/// How identification studies are run.
extern const RunKind kIdentificationRun;

}  // namespace poesy
