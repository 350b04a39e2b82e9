#pragma once

#include "engine/model/model.h"

namespace poesy::three_prs {

/// The 3-PRS parallel mechanism of San, Ding, Zhang, Wu 2023, Actuators 12, 324, at two fidelities.
CatalogEntry catalog_entry();

/// The five-degree-of-freedom hybrid machine of San, Ding, Zhang, Wu 2023, Actuators 12, 324, Section 2: the 3-PRS as a
/// head that two serial slides carry, at the head's fidelities. Pose coordinates alpha, beta, z, slide_x, slide_y; the
/// head's factors, in their order, then the slides'; the head's responses in the rack's frame {O}. Chart "tip": alpha,
/// beta and the tool tip.
CatalogEntry machine_catalog_entry();

}  // namespace poesy::three_prs
