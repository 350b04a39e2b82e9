#pragma once

#include <span>
#include <vector>

#include "models/assembly/assembly.h"

namespace poesy::assembly {

/// The geometry of a limb for given displacements of its joints.
struct LimbState {
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;  ///< twists, one in each column

  std::vector<Transform> before;  ///< [joints] base_T_joint before the joint moves
  std::vector<Transform> after;   ///< [joints] base_T_joint after the joint has moved
  Transform end;                  ///< pose of the limb's end; if the limb exerts no wrench, that of the body there
  Columns passive;                ///< J: twists of the end per unit displacement of each passive joint

  /// The twist of the limb's end per unit displacement of joint j, passive or driven.
  Screw twist(const chain::Joint& joint, std::size_t j) const { return chain::spatial_column(joint, before[j]); }
};

/// The state of a limb that begins at a body with the pose `from` (base_T_body). frames: the limb's fixed frames, with
/// or without errors. displacements: those of the limb's joints (rad, m).
LimbState limb_state(const Limb& limb, const Transform& from, std::span<const Transform> frames,
                     std::span<const double> displacements);

/// The states of all limbs. bodies: [bodies] base_T_body. frames: the fixed frames of each limb, with or without
/// errors. displacements: [joints of all limbs] (rad, m).
std::vector<LimbState> limb_states(const Assembly& assembly, std::span<const Transform> bodies,
                                   std::span<const std::vector<Transform>> frames,
                                   std::span<const double> displacements);

/// [6 limbs x (passive joints + 6 bodies)] The matrix B of B x = V_b - V_a - J dq for a limb from body a to body b (see
/// Equilibrium). Bodies do not include the base. The six rows of each limb are multiplied by the matrix `root`.
Eigen::MatrixXd motion_columns(const Assembly& assembly, std::span<const LimbState> limbs, const Matrix6& root);

/// The first-order twist of the limb's end per unit of a component of a frame's error. Let F be the pose, in the base
/// frame, of the place in the limb where the error acts. The twist is a column of Ad(F), or of -Ad(F) in the limb's
/// last frame, to which the inverse of the error is applied. component: index in [omega; v].
Screw error_twist(const Limb& limb, const Transform& from, const LimbState& state, std::size_t frame,
                  std::size_t component);

}  // namespace poesy::assembly
