#pragma once

#include <memory>

#include "engine/model/model.h"
#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// An evaluator like deformation_evaluator(), but with the platform's displacement after the best correction by the
/// drives (Model::calibrated_evaluator, left_by_drives). The evaluator projects the rotation and the displacement of
/// the platform's origin onto the part that no correction can remove. The displacement of the tool and the norms follow
/// from the projected motion, with finite rotations if the fidelity is exact. Deformations and additional outputs are
/// unchanged, because corrections do not affect them. Every sample is singular at a pose at which passive joints are
/// singular. The model must outlive the evaluator. Precondition: there are at least three platform->points, not all on
/// a line.
std::unique_ptr<Evaluator> calibrated_evaluator(const DeformationModel& model, const SolverOptions& options,
                                                Fidelity fidelity);

}  // namespace poesy::chain
