#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/chain/first_order.h"
#include "models/chain/limb.h"

namespace poesy::chain {

/// First-order residuals in few coordinates. Consider L limbs with F passive joints in total. The mismatch that no
/// joint can remove has D = 6 (L - 1) - F independent components; D is the degree of over-constraint. The vector y [D]
/// has their coordinates in an orthonormal basis, so |y|^2 = sum of |delta_mu|^2 over the pairs. The effect of an error
/// thus takes D numbers instead of six for each pair.
class ResidualSpace {
 public:
  /// Allocates scratch memory for the chain, which must outlive this object. Precondition: the chain's pairs connect
  /// all limbs.
  explicit ResidualSpace(const ParallelChain& chain);

  /// Computes the basis. Precondition: first_order.prepare() has returned true for W = 1.
  void prepare(const FirstOrder& first_order);

  /// The degree of over-constraint D.
  std::size_t dimensions() const { return dimensions_; }
  /// Adds to y [D] the effect of a component of a frame's error of this size (rad, m).
  void add(const FirstOrder& first_order, const FrameEntry& entry, double error, std::span<double> y) const;
  /// Adds to y [D] the effect of a small motion of a limb's platform, after the reaction of the passive joints.
  void add(std::size_t limb, const lie::Screw<double>& motion, std::span<double> y) const;
  /// The matrix [6 x pairs, D] from y to delta_mu.
  const Eigen::MatrixXd& delta_mu() const { return delta_mu_; }

 private:
  void find_basis(const FirstOrder& first_order);

  const ParallelChain* chain_;
  /// [L - 1, L] Matrix N with N^T N = incidence^T incidence, for L limbs (independent_rows()).
  Eigen::MatrixXd independent_;
  Eigen::MatrixXd of_pairs_;              ///< [pairs, L - 1] matrix with incidence = of_pairs N
  std::size_t dimensions_ = 0;            ///< number D of dimensions of the residual space
  Eigen::MatrixXd columns_;               ///< [6 (L - 1), F] columns of the passive joints
  Eigen::MatrixXd basis_;                 ///< [6 (L - 1), D] orthonormal basis of the complement of the columns
  std::vector<Eigen::MatrixXd> of_limb_;  ///< [D, 6] for each limb, the matrix from a motion of its platform to y
  Eigen::MatrixXd delta_mu_;
};

}  // namespace poesy::chain
