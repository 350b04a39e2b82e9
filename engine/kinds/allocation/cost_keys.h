#pragma once

#include <string>

#include "engine/kinds/allocation/result.h"
#include "engine/study/study_kind.h"

/// Reads and writes, in study files, the cost of a part as a function of its tolerance.
namespace poesy::allocation {

/// The keys of a cost in study files. They are the same for the cost of a part and the cost of a process.
StudyTable cost_table();

/// Reads a cost. dimension: dimension of the tolerance (length, angle or number). Throws InputError at the value if the
/// value is not a cost.
StatedCost read_cost(const StudyValue& value, Dimension dimension);

/// The cost as an inline table of TOML, which reads back as the same cost. Precondition: the cost has a law.
std::string cost_text(const StatedCost& cost, Dimension dimension);

}  // namespace poesy::allocation
