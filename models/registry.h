#pragma once

#include "engine/model/model.h"

namespace poesy {

/// The only list of mechanisms.
const Catalog& registry();

}  // namespace poesy
