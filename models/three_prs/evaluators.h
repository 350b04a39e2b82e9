#pragma once

#include <memory>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {

inline constexpr std::size_t kComponents = 9;  ///< responses that are components of vectors: rows kTheta, kDr, kTip
inline constexpr std::size_t kResponses = kComponents + 3;

/// What both evaluators give, in this order: theta_x, _y, _z (rotation vector of the platform), x, y, z (displacement
/// of P), tip_x, _y, _z (of the tool tip), in the base frame, then the norms rotation, position, tip_position.
std::vector<Response> responses();

/// One detail, `swing`: additional swing dphi_i of the three rods, rad.
std::vector<Detail> details();

/// [theta; dr] = J^-1 G eps (San et al. 2023, Eq. 18, corrected): one matrix for each block, one product for each
/// sample, by vectors (map_tile). Every sample converges in one iteration; at a singular pose every sample is singular.
std::unique_ptr<Evaluator> first_order_evaluator(const Geometry& geometry);

/// The closure of all limbs with errors and rotations of finite size (ClosureSolver), started from the first order
/// (ClosureStart).
std::unique_ptr<Evaluator> exact_evaluator(const Geometry& geometry, const SolverOptions& options);

}  // namespace poesy::three_prs
