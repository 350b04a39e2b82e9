#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Sensitivity studies: the effect of each error on its own.
extern const Kind kSensitivityKind;

}  // namespace poesy
