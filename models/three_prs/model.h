#pragma once

#include "engine/model/model.h"

namespace poesy::three_prs {

/// The 3-PRS parallel mechanism of San, Ding, Zhang, Wu 2023, Actuators 12, 324, at two fidelities.
CatalogEntry catalog_entry();

/// The five-degree-of-freedom hybrid machine of San, Ding, Zhang, Wu 2023, Actuators 12, 324, Section 2. Two serial
/// slides carry the 3-PRS as a head; fidelities are those of the head. Pose coordinates are `alpha`, `beta`, `z`,
/// `slide_x`, `slide_y`. Factors are the errors of the head, in their order, then those of the slides. Responses are
/// those of the head, in the rack's frame {O}. The coordinates of the pose chart "tip" are `alpha`, `beta` and the
/// position of the tool tip.
CatalogEntry machine_catalog_entry();

}  // namespace poesy::three_prs
