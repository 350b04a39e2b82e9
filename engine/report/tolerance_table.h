#pragma once

#include <string>

#include "engine/io/tolerance_files.h"
#include "engine/report/table.h"

namespace poesy {

/// Tolerances of every error for one response, in mm and deg; notes say from which reference and limit, and the root
/// mean square that the equal-effect tolerances are predicted to give.
Table tolerance_table(const StoredResult& result, const ResponseTolerances& tolerances);

/// A value of a response in the unit in which people read it, "0.05 mm".
std::string response_text(const NamedUnit& response, double si);

}  // namespace poesy
