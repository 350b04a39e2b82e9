#pragma once

#include <string>

#include "engine/kinds/allocation/result.h"
#include "engine/study/study_kind.h"

/// Reads and writes the cost of a tolerance in study files.
namespace poesy {

StudyTable cost_table();  ///< The keys of a cost, the same for a part and for a process.

/// Reads the cost of a tolerance. The dimension is a length or an angle. Throws InputError at the value if it is not a
/// cost.
StatedCost read_cost(const StudyValue& value, Dimension dimension);

/// An inline table of TOML that reads back to the same cost. Precondition: it has a law.
std::string cost_text(const StatedCost& cost, Dimension dimension);

}  // namespace poesy
