#pragma once

#include <optional>
#include <span>

#include "models/assembly/model.h"

namespace poesy::assembly {

/// The separation of errors as in chain::separation(): the part of an error's effect on the platform that the drives of
/// the error's limb can remove, and the part that remains after the best correction by all drives. All numbers are NaN
/// if the equations have no unique solution.
Separation separation(const AssemblyModel& model, std::span<const double> pose);

/// The description of separation() for this model.
SeparationDescription separation_description(const AssemblyModel& model);

}  // namespace poesy::assembly
