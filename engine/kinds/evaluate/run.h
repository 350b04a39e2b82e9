#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// How studies of named cases are run.
extern const RunKind kCasesRun;

}  // namespace poesy
