#pragma once

#include <span>

#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// The trace of a solve by DeformationSolver: the published Gauss-Newton method from nominal displacements, whatever
/// method the options name. pose: reachable, SI. errors: the value of each error of the model, SI.
SolveTrace deformation_trace(const DeformationModel& model, std::span<const double> pose,
                             std::span<const double> errors, const SolverOptions& options);

/// The trace of a first-order evaluation in closed form, which does not iterate. pose: reachable, SI. errors: the value
/// of each error of the model, SI.
SolveTrace first_order_trace(const DeformationModel& model, std::span<const double> pose,
                             std::span<const double> errors);

}  // namespace poesy::chain
