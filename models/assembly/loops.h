#pragma once

#include <span>
#include <vector>

#include "models/assembly/nominal.h"

namespace poesy::assembly {

/// The loops of a perfect assembly at a pose, weighed by the platform's points: B of B x = V_b - V_a - J dq
/// (motion_columns) and N = B^T W B, without the motions of passive joints that are idle there.
class Loops {
 public:
  /// The assembly and the pose must outlive it. idle: freedoms of passive joints that move no body.
  Loops(const Assembly& assembly, const Nominal& pose, std::size_t idle);

  /// Whether N is not singular. All that follows is only for loops that are regular.
  bool is_regular() const { return is_regular_; }

  /// The motions x that count, [x x motions], such that B times each of them has length 1 by W.
  const Eigen::MatrixXd& motions() const { return motions_; }

  /// The part of a mismatch W^(1/2) xi [6 limbs] that bodies and joints could take away.
  Eigen::VectorXd taken_away(const Eigen::VectorXd& mismatch) const;

  /// By how much a unit of each error changes ln det N to first order, while bodies and joints give way: the slopes
  /// times error_twist(). [limbs][n + 1], of each limb's frames.
  std::vector<std::vector<Screw>> determinant_slopes() const;

 private:
  const Assembly* assembly_;
  const Nominal* pose_;
  Matrix6 root_;             ///< W^(1/2)
  Eigen::MatrixXd motions_;  ///< see motions()
  Eigen::MatrixXd weighed_;  ///< W^(1/2) B motions, [6 limbs x motions], orthonormal
  bool is_regular_;
};

/// C(r): what mismatches r [limbs] by the metric W add to N = B^T W B in the derivative of B^T W xi, symmetric, with
/// limbs and bodies where these states are.
Eigen::MatrixXd bend(const Assembly& assembly, std::span<const LimbState> limbs, std::span<const Screw> r,
                     const Matrix6& W);

}  // namespace poesy::assembly
