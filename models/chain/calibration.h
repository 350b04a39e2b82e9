#pragma once

#include <memory>

#include "engine/model/model.h"
#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// An evaluator like deformation_evaluator() whose displacement of the platform is what remains after the best
/// correction of the drives (Model::calibrated_evaluator, left_by_drives). Rotation and displacement of the platform's
/// origin are projected; the tool's displacement and the norms follow from the projected motion, with finite rotations
/// if the fidelity is exact. Responses of the deformation and details are unchanged, because corrections do not affect
/// them. Where passive joints are in a singular configuration every sample is singular. The model must outlive the
/// evaluator. Precondition: platform->points are at least three, not all on a line.
std::unique_ptr<Evaluator> calibrated_evaluator(const DeformationModel& model, const SolverOptions& options,
                                                Fidelity fidelity);

}  // namespace poesy::chain
