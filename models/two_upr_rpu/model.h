#pragma once

#include "engine/model/model.h"

namespace poesy::two_upr_rpu {

/// The 2UPR-RPU over-constrained manipulator of Du, Wang, Zheng 2022, Machines 10, 990.
CatalogEntry catalog_entry();

}  // namespace poesy::two_upr_rpu
