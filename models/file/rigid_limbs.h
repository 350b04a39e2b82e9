#pragma once

#include "models/assembly/model.h"
#include "models/file/mechanism.h"

namespace poesy::file {

/// Throws InputError where limbs that are rigid over-constrain each other at home, with their labels: then wrenches
/// exist that no load balances and that strain nothing, and the equations of the assembly do not say how large they
/// are. The assembly is the mechanism's by its stiffness.
void check_rigid_limbs(const Mechanism& mechanism, const assembly::AssemblyModel& model,
                       const assembly::Nominal& at_home);

}  // namespace poesy::file
