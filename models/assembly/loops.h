#pragma once

#include <span>
#include <vector>

#include "models/assembly/nominal.h"

namespace poesy::assembly {

/// The loops of a perfect assembly at a pose, weighed by the metric W of the platform's points. A vector x contains the
/// displacements dq of the passive joints and the twists V of the bodies. For a limb from body a to body b, x reduces
/// the mismatch to first order by B x = V_b - V_a - J dq, where J are the columns of the limb's passive joints
/// (motion_columns()). N is B^T W B, without the idle motions of passive joints.
class Loops {
 public:
  /// The assembly and the pose must outlive this object. idle: number of freedoms of passive joints that move no body.
  Loops(const Assembly& assembly, const Nominal& pose, std::size_t idle);

  /// Returns true if N is regular. All functions below require that it is.
  bool is_regular() const { return is_regular_; }

  /// The motions x that are not idle, one in each column. For each of them, B x has length 1 in the metric W.
  const Eigen::MatrixXd& motions() const { return motions_; }

  /// The part of a mismatch [6 x limbs] that motions of bodies and joints could remove. In argument and result, the
  /// mismatch xi of each limb is multiplied by W^(1/2).
  Eigen::VectorXd taken_away(const Eigen::VectorXd& mismatch) const;

  /// The slopes of ln det N (see the class) with respect to the errors of each limb's frames: a vector for each limb,
  /// with a slope (a wrench) for each frame. The product of a slope with error_twist() is the first-order change of ln
  /// det N per unit of an error, if bodies and joints follow the error.
  std::vector<std::vector<Screw>> determinant_slopes() const;

 private:
  const Assembly* assembly_;
  const Nominal* pose_;
  Matrix6 root_;             ///< root W^(1/2) of the metric
  Eigen::MatrixXd motions_;  ///< non-idle motions, see motions()
  Eigen::MatrixXd weighed_;  ///< [6 limbs x motions] W^(1/2) B motions, with orthonormal columns
  bool is_regular_;
};

/// The symmetric part of the matrix C(r) for limbs in these states, with mismatches r [limbs]. The matrix C(xi) is
/// defined by the derivative of B^T W xi with respect to x, which is -(N + C(xi)) for a mismatch xi (see Loops for B,
/// W, N and x).
Eigen::MatrixXd bend(const Assembly& assembly, std::span<const LimbState> limbs, std::span<const Screw> r,
                     const Matrix6& W);

}  // namespace poesy::assembly
