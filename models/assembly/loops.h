#pragma once

#include <span>
#include <vector>

#include "models/assembly/nominal.h"

namespace poesy::assembly {

/// The loops of a perfect assembly at a pose, weighed by the metric W of the platform's points. A vector x has the
/// twists V of the bodies and the displacements dq of the passive joints. B x = V_b - V_a - J dq is the change of the
/// mismatch of each limb from body a to body b, with the columns J of its passive joints (motion_columns()). N is B^T W
/// B, without the idle motions of passive joints.
class Loops {
 public:
  /// The assembly and the pose must outlive this object. idle: number of freedoms of passive joints that move no body.
  Loops(const Assembly& assembly, const Nominal& pose, std::size_t idle);

  /// Returns true if N is regular. All functions below require that it is.
  bool is_regular() const { return is_regular_; }

  /// [entries of x, motions] The motions x that are not idle. B x has length 1 in the metric W for each of them.
  const Eigen::MatrixXd& motions() const { return motions_; }

  /// The part of a mismatch that motions of bodies and joints could remove. The mismatch xi of each limb is multiplied
  /// by W^(1/2): [6 limbs].
  Eigen::VectorXd taken_away(const Eigen::VectorXd& mismatch) const;

  /// [limbs][n + 1] The slopes of ln det N by the errors of each limb's frames. The product of a slope with
  /// error_twist() is the first-order change per unit of an error, if bodies and joints follow the error.
  std::vector<std::vector<Screw>> determinant_slopes() const;

 private:
  const Assembly* assembly_;
  const Nominal* pose_;
  Matrix6 root_;             ///< root W^(1/2) of the metric
  Eigen::MatrixXd motions_;  ///< non-idle motions, see motions()
  Eigen::MatrixXd weighed_;  ///< [6 limbs x motions] W^(1/2) B motions, with orthonormal columns
  bool is_regular_;
};

/// The symmetric matrix C(r) for limbs in these states, with mismatches r [limbs]. The derivative of B^T W xi (see
/// Loops; xi: mismatch) is N + C(r).
Eigen::MatrixXd bend(const Assembly& assembly, std::span<const LimbState> limbs, std::span<const Screw> r,
                     const Matrix6& W);

}  // namespace poesy::assembly
