#pragma once

#include <optional>
#include <span>

#include "models/assembly/model.h"

namespace poesy::assembly {

/// chain::separation() of an assembly: what the drive of an error's limb takes away, and what the best correction of
/// all drives leaves of its effect on the platform. NaN where the equations have no unique solution.
Separation separation(const AssemblyModel& model, std::span<const double> pose);

/// What length it speaks of.
SeparationDescription separation_description(const AssemblyModel& model);

}  // namespace poesy::assembly
