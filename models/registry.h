#pragma once

#include "engine/model/catalog.h"

namespace poesy {

/// The only list of mechanisms.
const Catalog& registry();

}  // namespace poesy
