#pragma once

#include <span>
#include <vector>

#include "models/assembly/nominal.h"

namespace poesy::assembly {

/// Wrenches of limbs and twists of bodies, a column for each right side.
struct Balance {
  Eigen::MatrixXd wrenches;  ///< [6 limbs x k] p: what each limb exerts on the body at its end
  Eigen::MatrixXd twists;    ///< [6 bodies x k] V; the base's is 0
};

/// The linear equations of an assembly at one state,
///
///     [ C  B ; B^T  0 ] [ p ; x ] = [ xi ; -load ],      B x = V_b - V_a - J dq for a limb from a to b.
///
/// What the passive joints take away goes first: with N the wrenches that a limb can carry (J^T N = 0) p = N lambda,
///
///     N^T C N lambda + N^T (V_b - V_a) = N^T xi,    sum of N lambda into b less that from b = -load_b.
///
/// Written with C and not with its inverse, so that a limb may be rigid. Inside, lengths are in units of the reach,
/// and compliances in units of the largest.
class Equilibrium {
 public:
  /// Inside, about the platform's origin. The assembly must outlive it.
  Equilibrium(const Assembly& assembly, const Nominal& pose);

  /// Inside, about the origin of this frame and along its axes (base_T_frame).
  Equilibrium(const Assembly& assembly, const Nominal& pose, const Transform& frame);

  /// The equations with these columns [limbs] of the passive joints. ranks: of them, [limbs].
  void set(std::span<const LimbState> limbs, std::span<const std::size_t> ranks);

  /// xi: [6 limbs x k]; load: [6 bodies x k], of which the base's rows are ignored. NaN or infinite where the equations
  /// have no unique solution.
  Balance solve(const Eigen::MatrixXd& xi, const Eigen::MatrixXd& load) const;

  /// dq of the limb's passive joints, of least norm, with V_b - V_a - J dq = closing.
  Eigen::VectorXd displacements(std::size_t limb, const Screw& wanted) const;

  /// The largest distance by which a twist of a body moves its points, over the reach, about.
  double size(const Screw& twist) const { return (to_unit_ * twist).norm(); }

  /// The matrix [(wrenches + 6 bodies) squared], without unit; a null vector is a wrench that rigid limbs put on each
  /// other, or a motion of loose bodies.
  const Eigen::MatrixXd& matrix() const { return matrix_; }
  /// Of each limb, where its part of the unknown wrenches begins, and at last how many there are.
  std::span<const Eigen::Index> first_wrenches() const { return first_; }
  const Eigen::MatrixXd& carry(std::size_t limb) const { return carry_[limb]; }    ///< N [6 x (6 - rank)], in units
  const Eigen::MatrixXd& give(std::size_t limb) const { return give_[limb]; }      ///< to dq [n x 6], in units
  const Matrix6& compliance(std::size_t limb) const { return compliance_[limb]; }  ///< C in units

  /// To units.
  /// @{
  const Matrix6& twists_in_units() const { return to_unit_; }
  Screw wrench_in_units(const Screw& wrench) const { return unit_ * (from_unit_.transpose() * wrench); }
  /// @}
  double compliance_unit() const { return unit_; }  ///< the moment's unit (N m) is its inverse

 private:
  const Assembly* assembly_;
  Matrix6 to_unit_;                     ///< twist in units from twist
  Matrix6 from_unit_;                   ///< its inverse
  double unit_;                         ///< of compliance
  std::vector<Matrix6> compliance_;     ///< [limbs] in units
  std::vector<Eigen::MatrixXd> carry_;  ///< [limbs] N [6 x (6 - rank)]
  std::vector<Eigen::MatrixXd> give_;   ///< [limbs] to the passive joints' displacements [n x 6]
  std::vector<Eigen::Index> first_;     ///< [limbs + 1] of the limb's lambda among all
  Eigen::MatrixXd matrix_;
};

}  // namespace poesy::assembly
