#pragma once

#include <span>
#include <vector>

#include "models/assembly/assembly.h"

namespace poesy::assembly {

/// A limb with its joints displaced.
struct LimbState {
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;  ///< twists, one a column

  std::vector<Transform> before;  ///< [joints] base_T_joint before the joint's motion
  std::vector<Transform> after;   ///< [joints] and behind it
  Transform end;                  ///< where the limb puts the frame of the body at its end, if no force acts
  Columns passive;                ///< J: the end's twists by the passive joints, in their order

  /// The end's twist by a joint, a column of J or of a drive.
  Screw twist(const chain::Joint& joint, std::size_t j) const { return chain::spatial_column(joint, before[j]); }
};

/// T_a g_e(q) of a limb that begins at the body frame `from` (base_T_a). frames: [n + 1] with or without errors;
/// displacements: [n] of its joints (rad, m).
LimbState limb_state(const Limb& limb, const Transform& from, std::span<const Transform> frames,
                     std::span<const double> displacements);

/// All limbs, with their bodies [bodies] there and joints [joints of all limbs] so displaced. frames: [limbs][n + 1].
std::vector<LimbState> limb_states(const Assembly& assembly, std::span<const Transform> bodies,
                                   std::span<const std::vector<Transform>> frames,
                                   std::span<const double> displacements);

/// B of B x = V_b - V_a - J dq for a limb from a to b, with the rows of each limb times `root`: [6 limbs x (passive
/// joints + 6 bodies)], bodies without the base.
Eigen::MatrixXd motion_columns(const Assembly& assembly, std::span<const LimbState> limbs, const Matrix6& root);

/// The end's twist by a unit of an entry of a frame's error, to first order: a column of G (Ad(F) before the error,
/// -Ad(F) in the last frame, where the inverse multiplies from the right). component: of [omega; v].
Screw error_twist(const Limb& limb, const Transform& from, const LimbState& state, std::size_t frame,
                  std::size_t component);

}  // namespace poesy::assembly
