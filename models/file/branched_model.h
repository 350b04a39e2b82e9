#pragma once

#include <memory>

#include "models/assembly/model.h"
#include "models/chain/block_solver.h"
#include "models/file/rounding.h"

namespace poesy::file {

/// The mechanism as solvers of limbs between bodies have it. home: its mobility there. Throws InputError where limbs
/// are rigid and over-constrain each other, by the metric "stiffness".
assembly::AssemblyModel assembly_model(const Mechanism& mechanism, std::shared_ptr<const Tracker> tracker,
                                       const Mobility& home, assembly::Metric metric);

/// A mechanism with bodies between its limbs, or with stiffness. Throws InputError where limbs are rigid and
/// over-constrain each other.
std::unique_ptr<Model> branched_model(const MechanismFile& file, Checked found, assembly::Metric metric,
                                      chain::Fidelity fidelity);

}  // namespace poesy::file
