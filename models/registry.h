#pragma once

#include "engine/model/model.h"

namespace poesy {

/// The catalog of all mechanisms that are built into the program. No other list of them exists.
const Catalog& registry();

}  // namespace poesy
