#pragma once

#include "engine/kinds/kind.h"

namespace poesy::extremes {

/// The smallest and the largest value of each response at each pose, with the sample that gave it.
extern const Kind kKind;

}  // namespace poesy::extremes
