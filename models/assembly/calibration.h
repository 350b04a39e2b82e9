#pragma once

#include <memory>

#include "engine/model/model.h"
#include "models/assembly/model.h"

namespace poesy::assembly {

/// An evaluator like assembly_evaluator(), but with displacements after the best correction by the drives
/// (Model::calibrated_evaluator). The correction dq is found to first order at the pose: it minimises the root mean
/// square displacement of the platform's points. If several dq do so, the one with the least norm is taken; this norm
/// weighs the displacement of each drive by the root mean square displacement of the points that a unit of it causes.
/// The correction moves the platform and all other bodies. Rotation vectors and displacements of origins are corrected.
/// The displacement of the tool and the norms follow from the corrected values, with finite rotations if the fidelity
/// is exact. Mismatch, energy and forces are unchanged: to first order, a correction puts no force on limbs if there
/// are as many drives as freedoms. If the equations have no unique solution, every sample has the status singular. The
/// model must outlive the evaluator.
std::unique_ptr<Evaluator> calibrated_evaluator(const AssemblyModel& model, const SolverOptions& options,
                                                chain::Fidelity fidelity);

}  // namespace poesy::assembly
