#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "models/chain/first_order.h"
#include "models/chain/limb.h"
#include "models/chain/metric.h"

namespace poesy::chain {

/// What errors leave to first order, in few numbers. Of L limbs with F passive joints the mismatch that no joint can
/// take away has D = 6 (L - 1) - F independent components; D is how often the mechanism is over-constrained. y [D] are
/// its coordinates in an orthonormal basis by the metric, |y|^2 = sum |delta_mu|_W^2 over the pairs, so that an error
/// has D numbers instead of six for each pair.
class ResidualSpace {
 public:
  /// Scratch for the chain, which must outlive it. Precondition: its pairs connect all limbs.
  explicit ResidualSpace(const ParallelChain& chain);

  /// Where the first order was prepared, and returned true; metric: null for W = 1.
  void prepare(const FirstOrder& first_order, const Metric* metric);

  /// D.
  std::size_t dimensions() const { return dimensions_; }
  /// Adds to y [D] what this much of a frame's error makes (SI).
  void add(const FirstOrder& first_order, const FrameEntry& entry, double error, std::span<double> y) const;
  /// Adds to y [D] a small motion of a limb's platform, of which passive joints take away what they can.
  void add(std::size_t limb, const lie::Screw<double>& motion, std::span<double> y) const;
  /// delta_mu of y, [6 x pairs, D].
  const Eigen::MatrixXd& delta_mu() const { return delta_mu_; }
  /// By a metric: upper triangles R [D, D] so that gap, angular and linear deformation are |R y|.
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
  Eigen::MatrixXd basis_;                 ///< [6 (L - 1), D] at right angles to the columns
  std::vector<Eigen::MatrixXd> of_limb_;  ///< [D, 6] y of a motion of the limb's platform
  Eigen::MatrixXd delta_mu_;
  Eigen::MatrixXd rows_;  ///< [3 pairs, D]
  std::array<Eigen::MatrixXd, 3> norms_;
};

}  // namespace poesy::chain
