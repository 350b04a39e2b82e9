#pragma once

#include "engine/model/status.h"
#include "engine/study/study.h"

namespace poesy {

/// Whether a sample that ended so enters statistics. A singular or non-finite one never does.
constexpr bool counts(SolveStatus status, NotConverged policy) {
  return solved(status) || (policy == NotConverged::include && usable(status));
}

}  // namespace poesy
