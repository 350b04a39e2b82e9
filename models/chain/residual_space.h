#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "models/chain/first_order.h"
#include "models/chain/limb.h"
#include "models/chain/metric.h"

namespace poesy::chain {

/// First-order residuals in few coordinates. For L limbs with F passive joints the mismatch that no joint can remove
/// has D = 6 (L - 1) - F independent components; D is the degree of over-constraint. y [D] are its coordinates in a
/// basis that is orthonormal by the metric, |y|^2 = sum |delta_mu|_W^2 over the pairs, so that an error has D numbers
/// instead of six for each pair.
class ResidualSpace {
 public:
  /// Allocates scratch for the chain, which must outlive it. Precondition: its pairs connect all limbs.
  explicit ResidualSpace(const ParallelChain& chain);

  /// Computes the basis. first_order: its prepare() has returned true; metric: null for W = 1.
  void prepare(const FirstOrder& first_order, const Metric* metric);

  /// D, the degree of over-constraint.
  std::size_t dimensions() const { return dimensions_; }
  /// Adds the effect of an entry of a frame's error of this size (rad, m) to y [D].
  void add(const FirstOrder& first_order, const FrameEntry& entry, double error, std::span<double> y) const;
  /// Adds to y [D] the effect of a small motion of a limb's platform, after the reaction of the passive joints.
  void add(std::size_t limb, const lie::Screw<double>& motion, std::span<double> y) const;
  /// The matrix [6 x pairs, D] from y to delta_mu.
  const Eigen::MatrixXd& delta_mu() const { return delta_mu_; }
  /// By a metric: upper triangles R [D, D]; gap, angular and linear deformation are |R y|.
  const std::array<Eigen::MatrixXd, 3>& norms() const { return norms_; }

 private:
  void find_basis(const FirstOrder& first_order);
  void find_norms(const Metric& metric);

  const ParallelChain* chain_;
  Eigen::MatrixXd independent_;           ///< [L - 1, L] N with N^T N = incidence^T incidence
  Eigen::MatrixXd of_pairs_;              ///< [pairs, L - 1] incidence = of_pairs N
  std::size_t dimensions_ = 0;            ///< D
  lie::Matrix6<double> root_;             ///< U with U^T U = W
  lie::Matrix6<double> inverse_;          ///< of U
  Eigen::MatrixXd columns_;               ///< [6 (L - 1), F] of the passive joints
  Eigen::MatrixXd basis_;                 ///< [6 (L - 1), D] orthonormal basis perpendicular to the columns
  std::vector<Eigen::MatrixXd> of_limb_;  ///< [D, 6] from a motion of the limb's platform to y
  Eigen::MatrixXd delta_mu_;
  Eigen::MatrixXd rows_;  ///< [3 pairs, D]
  std::array<Eigen::MatrixXd, 3> norms_;
};

}  // namespace poesy::chain
