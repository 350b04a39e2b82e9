#pragma once

#include <optional>

#include "engine/kinds/kind.h"
#include "engine/result/drawing_result.h"

namespace poesy {

/// The effect of the features of the mechanism's drawing on the responses, to first order (DrawingResult). Slopes of
/// the responses are central differences; the step is a sixteenth of the error's standard deviation. None if the study
/// draws no errors, or if no feature scatters.
std::optional<DrawingResult> drawing_result(const StudyRun& run);

}  // namespace poesy
