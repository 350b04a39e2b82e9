#pragma once

#include <string>

#include "engine/io/tolerance_files.h"

namespace poesy {

/// Tolerances of every error for one response, in mm and deg, under lines that say from which reference and limit, and
/// with the root mean square that the equal-effect tolerances are predicted to give.
std::string tolerance_table(const StoredResult& result, const ResponseTolerances& tolerances);

/// A value of a response in the unit in which people read it, "0.05 mm".
std::string response_text(const NamedUnit& response, double si);

}  // namespace poesy
