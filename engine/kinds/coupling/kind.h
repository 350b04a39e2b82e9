#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Coupling: error sources of fixed size, one by one and together.
extern const Kind kCouplingKind;

}  // namespace poesy
