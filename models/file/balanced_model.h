#pragma once

#include <memory>

#include "models/assembly/model.h"
#include "models/chain/block_solver.h"
#include "models/file/pose_tracker.h"
#include "models/file/rounding.h"
#include "models/file/tracked_model.h"

namespace poesy::file {

/// The mechanism in the form that solvers of limbs between bodies need. home: the mechanism's mobility at the home
/// pose. Throws InputError if rigid limbs over-constrain each other and the metric is "stiffness".
assembly::AssemblyModel assembly_model(const Mechanism& mechanism, std::shared_ptr<const PoseTracker> tracker,
                                       const Mobility& home, assembly::Metric metric);

/// The model in which limbs and bodies are in equilibrium; `metric` determines the compliances of the limbs. Throws
/// InputError if rigid limbs over-constrain each other and the metric is "stiffness".
std::unique_ptr<TrackedModel> balanced_model(const MechanismFile& file, Checked found, assembly::Metric metric,
                                             chain::Fidelity fidelity);

}  // namespace poesy::file
