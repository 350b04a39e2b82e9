#pragma once

#include <memory>

#include "models/assembly/model.h"
#include "models/chain/block_solver.h"
#include "models/file/rounding.h"
#include "models/file/tracked_model.h"

namespace poesy::file {

/// The mechanism in the form for solvers of limbs between bodies. home: its mobility there. Throws InputError if rigid
/// limbs over-constrain each other and the metric is "stiffness".
assembly::AssemblyModel assembly_model(const Mechanism& mechanism, std::shared_ptr<const Tracker> tracker,
                                       const Mobility& home, assembly::Metric metric);

/// The model of a mechanism that has bodies between its limbs, or stiffness. Throws InputError if rigid limbs
/// over-constrain each other.
std::unique_ptr<TrackedModel> branched_model(const MechanismFile& file, Checked found, assembly::Metric metric,
                                             chain::Fidelity fidelity);

}  // namespace poesy::file
