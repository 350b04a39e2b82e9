#pragma once

#include <string>

#include "engine/kinds/allocation/result.h"
#include "engine/study/study_kind.h"

/// What a tolerance costs, as a study file states it.
namespace poesy {

StudyTable cost_table();  ///< Its keys, of a part and of a process.

/// Reads the cost of a tolerance of this dimension, which is a length or an angle. Throws InputError at its place for
/// what is no cost.
StatedCost read_cost(const StudyValue& value, Dimension dimension);

/// An inline table of TOML that reads back to the same cost. Precondition: it has a law.
std::string cost_text(const StatedCost& cost, Dimension dimension);

}  // namespace poesy
