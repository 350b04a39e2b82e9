#pragma once

#include <span>

#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// A solve by DeformationSolver: published Gauss-Newton from nominal displacements, whatever the options' method. pose:
/// reachable; errors: [F], SI.
SolveTrace deformation_trace(const DeformationModel& model, std::span<const double> pose,
                             std::span<const double> errors, const SolverOptions& options);

/// The first-order closed form, which does not iterate. pose: reachable; errors: [F], SI.
SolveTrace first_order_trace(const DeformationModel& model, std::span<const double> pose,
                             std::span<const double> errors);

}  // namespace poesy::chain
