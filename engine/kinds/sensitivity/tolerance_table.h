#pragma once

#include "engine/kinds/sensitivity/tolerance_files.h"
#include "engine/report/display.h"
#include "engine/report/table.h"

namespace poesy {

/// Tolerances of every error for one response, in mm and deg; notes say from which reference and limit, and the root
/// mean square that the equal-effect tolerances are predicted to give.
Table tolerance_table(const StoredResult& result, const ResponseTolerances& tolerances);

}  // namespace poesy
