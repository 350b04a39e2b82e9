#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Monte Carlo studies: all errors vary together.
extern const Kind kMonteCarloKind;

}  // namespace poesy
