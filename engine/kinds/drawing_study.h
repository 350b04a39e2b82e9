#pragma once

#include <optional>

#include "engine/kinds/kind.h"
#include "engine/result/drawing_result.h"

namespace poesy {

/// The effect of a drawing's features on the responses, to first order (DrawingResult). The slopes of the responses
/// with respect to the features' errors are central differences with a step of a sixteenth of an error's standard
/// deviation. None if the study draws no errors, or if no feature scatters.
std::optional<DrawingResult> drawing_result(const StudyRun& run);

}  // namespace poesy
