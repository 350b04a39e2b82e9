#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/chain/first_order.h"
#include "models/chain/limb.h"

namespace poesy::chain {

/// Describes first-order residuals by few coordinates. Consider L limbs with F passive joints in total. The mismatch
/// that no joint can remove has D = 6 (L - 1) - F independent components; D is the degree of over-constraint. The
/// vector y [D] has their coordinates in an orthonormal basis, so |y|^2 = sum of |delta_mu|^2 over the pairs. The
/// effect of an error thus takes D numbers instead of six for each pair.
class ResidualSpace {
 public:
  /// Allocates scratch memory for the chain. Precondition: the chain's pairs connect all limbs.
  explicit ResidualSpace(const ParallelChain& chain);

  /// Computes the basis. Precondition: first_order.prepare() has returned true for W = 1.
  void prepare(const FirstOrder& first_order);

  /// The degree of over-constraint D.
  std::size_t dimensions() const { return dimensions_; }
  /// Adds to y [dimensions()] the effect of an error (rad, m) in the component `entry` of a frame's error.
  void add(const FirstOrder& first_order, const FrameEntry& entry, double error, std::span<double> y) const;
  /// Adds to y [dimensions()] the effect of a small motion of a limb's end, after the reaction of the passive joints.
  void add(std::size_t limb, const lie::Screw<double>& motion, std::span<double> y) const;
  /// The matrix from the coordinates y to the residuals delta_mu: 6 rows for each pair of limbs, dimensions() columns.
  const Eigen::MatrixXd& delta_mu() const { return delta_mu_; }

 private:
  void find_basis(const FirstOrder& first_order);

  /// For L limbs, the matrix N [L - 1, L] with N^T N = incidence^T incidence. The incidence matrix has a row for each
  /// pair of limbs, with 1 for limb k and -1 for limb i.
  Eigen::MatrixXd independent_;
  Eigen::MatrixXd of_pairs_;              ///< [pairs, L - 1] matrix P with incidence matrix = P N
  std::size_t dimensions_ = 0;            ///< number D of dimensions of the residual space
  Eigen::MatrixXd columns_;               ///< [6 (L - 1), passive joints] N times the columns of the joints
  Eigen::MatrixXd basis_;                 ///< orthonormal basis of the complement of columns_
  std::vector<Eigen::MatrixXd> of_limb_;  ///< for each limb, the matrix from a motion of its end to y
  Eigen::MatrixXd delta_mu_;
};

}  // namespace poesy::chain
