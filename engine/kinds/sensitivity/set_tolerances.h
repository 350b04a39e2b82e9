#pragma once

#include "engine/kinds/tolerances.h"

namespace poesy {

/// Tolerances from the indices of a sensitivity result; see SetTolerances.
std::string set_sensitivity_tolerances(const StoredResult& result, const TolerancesOptions& options,
                                       const Catalog& catalog, std::size_t width);

}  // namespace poesy
