#pragma once

#include <optional>

#include "engine/kinds/kind.h"
#include "engine/result/drawing_result.h"

namespace poesy {

/// What the features of a mechanism's drawing do in their zones, to first order (DrawingResult): from the slopes of the
/// responses by each error, differences of two solves at a sixteenth of its standard deviation. None where features do
/// not scatter in zones, and for studies that draw no errors.
std::optional<DrawingResult> drawing_result(const StudyRun& run);

}  // namespace poesy
