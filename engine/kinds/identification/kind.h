#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Identification: which errors deform the mechanism at all.
extern const Kind kIdentificationKind;

}  // namespace poesy
