#pragma once

#include "engine/model/model.h"

namespace poesy::three_prs {

/// The 3-PRS parallel mechanism of San, Ding, Zhang, Wu 2023, Actuators 12, 324, at two fidelities.
CatalogEntry catalog_entry();

/// The five-degree-of-freedom hybrid machine of San, Ding, Zhang, Wu 2023, Actuators 12, 324, Section 2: the 3-PRS as a
/// head carried by two serial slides, at the head's fidelities. Pose coordinates are alpha, beta, z, slide_x, slide_y.
/// Factors are the head's, in their order, then the slides'. Responses are the head's, in the rack's frame {O}. The
/// chart "tip" has alpha, beta and the position of the tool tip.
CatalogEntry machine_catalog_entry();

}  // namespace poesy::three_prs
