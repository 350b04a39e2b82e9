#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Named cases of fixed errors.
extern const Kind kEvaluateKind;

}  // namespace poesy
