#pragma once

#include <span>
#include <vector>

#include "models/assembly/nominal.h"

namespace poesy::assembly {

/// The wrenches of limbs and twists of bodies that solve the equations of Equilibrium, with one column for each of k
/// right sides.
struct Balance {
  Eigen::MatrixXd wrenches;  ///< [6 limbs x k] p: wrench that each limb exerts on the body at its end
  Eigen::MatrixXd twists;    ///< [6 bodies x k] V: twist of each body; 0 for the base
};

/// The linear equations of an assembly in one state. The unknowns are the wrenches p of the limbs and a vector x, which
/// contains the displacements dq of passive joints and the twists V of bodies. C are the compliances of the limbs, xi
/// is their mismatch, and J are the columns of their passive joints.
///
///     [ C  B ; B^T  0 ] [ p ; x ] = [ xi ; -load ],      B x = V_b - V_a - J dq for a limb from a to b.
///
/// The displacements dq of the passive joints are eliminated first. Let the columns of N be a basis of the wrenches
/// that a limb can carry, so J^T N = 0 and p = N lambda. Then each limb from a body a to a body b, and each body b
/// except the base, has the equations
///
///     N^T C N lambda + N^T (V_b - V_a) = N^T xi
///     (sum of N lambda of the limbs that end at b) - (sum of N lambda of the limbs that begin at b) = -load_b.
///
/// The equations contain C and not its inverse, so a limb may be rigid. They are scaled: the unit of lengths is the
/// reach, and the unit of compliances is the largest compliance.
class Equilibrium {
 public:
  /// The scaled equations refer to the platform's origin. The assembly must outlive this object.
  Equilibrium(const Assembly& assembly, const Nominal& pose);

  /// The scaled equations refer to the origin and the axes of `frame` (base_T_frame).
  Equilibrium(const Assembly& assembly, const Nominal& pose, const Transform& frame);

  /// Sets up the equations for limbs in these states. ranks: [limbs] rank of the columns J of each limb's passive
  /// joints.
  void set(std::span<const LimbState> limbs, std::span<const std::size_t> ranks);

  /// Solves the equations for k right sides. xi: [6 limbs x k]. load: [6 bodies x k]; the rows of the base are ignored.
  /// The result is NaN or infinite if the equations have no unique solution.
  Balance solve(const Eigen::MatrixXd& xi, const Eigen::MatrixXd& load) const;

  /// The displacements dq of the limb's passive joints that bring the twist of the limb's end as close to `wanted` as
  /// possible. If several dq do so, the one with the least norm is returned.
  Eigen::VectorXd displacements(std::size_t limb, const Screw& wanted) const;

  /// Approximately the largest distance by which a twist moves a point of a body, divided by the reach.
  double size(const Screw& twist) const { return (to_unit_ * twist).norm(); }

  /// The scaled matrix of the equations. Its rows and columns belong to the lambda of all limbs, then to the bodies
  /// except the base, six for each body. A null vector is a set of wrenches by which rigid limbs load each other, or a
  /// motion of loose bodies.
  const Eigen::MatrixXd& matrix() const { return matrix_; }
  /// [limbs + 1] The index of each limb's first lambda among all lambda, then the number of all lambda.
  std::span<const Eigen::Index> first_wrenches() const { return first_; }
  /// [6 x (6 - rank)] The matrix N of a limb, scaled. Its columns are the wrenches that the limb can carry.
  const Eigen::MatrixXd& carry(std::size_t limb) const { return carry_[limb]; }
  /// The scaled matrix of displacements(), from a twist of the limb's end to dq. It has a row for each passive joint.
  const Eigen::MatrixXd& give(std::size_t limb) const { return give_[limb]; }
  const Matrix6& compliance(std::size_t limb) const {
    return compliance_[limb];
  }  ///< The compliance C of a limb, scaled.

  /// Conversion from SI to scaled quantities.
  /// @{
  const Matrix6& twists_in_units() const { return to_unit_; }
  Screw wrench_in_units(const Screw& wrench) const { return unit_ * (from_unit_.transpose() * wrench); }
  /// @}
  /// The unit of C, in 1/(N m). The unit of moments (N m) is its inverse.
  double compliance_unit() const { return unit_; }

 private:
  const Assembly* assembly_;
  Matrix6 to_unit_;                     ///< [6 x 6] from a twist to a scaled twist
  Matrix6 from_unit_;                   ///< inverse of to_unit_
  double unit_;                         ///< unit of C, 1/(N m)
  std::vector<Matrix6> compliance_;     ///< [limbs] scaled compliance C
  std::vector<Eigen::MatrixXd> carry_;  ///< [limbs] matrix N, see carry()
  std::vector<Eigen::MatrixXd> give_;   ///< [limbs] matrix from a twist to dq, see give()
  std::vector<Eigen::Index> first_;     ///< [limbs + 1] index of each limb's first lambda, see first_wrenches()
  Eigen::MatrixXd matrix_;
};

}  // namespace poesy::assembly
