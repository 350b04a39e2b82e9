#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// How coupling studies are run.
extern const RunKind kCouplingRun;

}  // namespace poesy
