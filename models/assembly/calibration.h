#pragma once

#include <memory>

#include "engine/model/model.h"
#include "models/assembly/model.h"

namespace poesy::assembly {

/// An evaluator like assembly_evaluator() whose bodies' displacements are what
/// remains after the best correction of the drives: dq of least norm with the
/// smallest root mean square displacement of the platform's points, to first
/// order at the pose, as Model::calibrated_evaluator has it. The platform and
/// all other bodies are moved back by dq; rotation vectors and displacements of
/// origins are corrected, and the tool's displacement and the norms follow from
/// them, with finite rotations if the fidelity is exact. Mismatch, energy and
/// forces are unchanged, because drives that are as many as the freedoms put no
/// force on limbs to first order. Where the equations have no unique solution
/// every sample is singular. The model must outlive the evaluator.
std::unique_ptr<Evaluator> calibrated_evaluator(const AssemblyModel& model, const SolverOptions& options,
                                                chain::Fidelity fidelity);

}  // namespace poesy::assembly
