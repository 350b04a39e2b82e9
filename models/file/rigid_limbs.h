#pragma once

#include "models/assembly/model.h"
#include "models/file/mechanism.h"

namespace poesy::file {

/// Throws InputError, with the labels of the limbs, if rigid limbs over-constrain each other at home. Then there are
/// wrenches that need no load and cause no strain, and the equations of the assembly do not determine their magnitudes.
/// model: the mechanism's assembly with stiffness.
void check_rigid_limbs(const Mechanism& mechanism, const assembly::AssemblyModel& model,
                       const assembly::Nominal& at_home);

}  // namespace poesy::file
