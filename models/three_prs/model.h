#pragma once

#include "engine/model/model.h"

namespace poesy::three_prs {

/// The 3-PRS parallel mechanism of San, Ding, Zhang, Wu 2023, Actuators 12, 324, at two fidelities.
CatalogEntry catalog_entry();

}  // namespace poesy::three_prs
