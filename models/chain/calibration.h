#pragma once

#include <memory>

#include "engine/model/model.h"
#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// As deformation_evaluator(), with what the best correction of the drives leaves of the platform's displacement
/// (Model::calibrated_evaluator, left_by_drives). Rotation and displacement of the platform's origin as the evaluator
/// gives them are projected; the tool's point and the norms are those of the rest, with rotations of finite size where
/// the fidelity is exact. Responses of the deformation and details stay as they are, because corrections leave them so.
/// Where passive joints are in a singular configuration every sample is singular. The model must outlive it.
/// Precondition: platform->points are at least three, on no line.
std::unique_ptr<Evaluator> calibrated_evaluator(const DeformationModel& model, const SolverOptions& options,
                                                Fidelity fidelity);

}  // namespace poesy::chain
