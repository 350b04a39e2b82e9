#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "models/chain/limb.h"

namespace poesy::chain {

/// The normal equations J^T W J x = J^T W delta_mu, which for W = 1 are Eq. 44. They are built from the columns of the
/// limbs. J of Eq. 43 contains each column twice with opposite signs and is never formed.
class NormalEquations {
 public:
  /// Allocates scratch for chains of this shape.
  explicit NormalEquations(const ParallelChain& chain);

  /// Solves for the motion deviations of the passive joints. columns: [passive joints]; delta_mu: [6 x pairs]; W: null
  /// for W = 1. damping: the diagonal of J^T W J is multiplied by 1 + damping. Returns false if a pivot falls to
  /// rounding relative to its diagonal entry; the solution is then undefined.
  bool solve(std::span<const lie::Screw<double>> columns, std::span<const double> delta_mu,
             const lie::Matrix6<double>* W = nullptr, double damping = 0.0);

  /// J^T W J [passive joints x passive joints] plus the rows of hold_idle(). Arguments as for solve().
  Eigen::MatrixXd matrix(std::span<const lie::Screw<double>> columns, const lie::Matrix6<double>* W);

  /// Fixes idle freedoms from now on: adds to J^T W J as many directions as the chain has idle freedoms. They are the
  /// directions of these columns [passive joints] that move no platform.
  void hold_idle(std::span<const lie::Screw<double>> columns, const lie::Matrix6<double>* W);
  /// The directions r that hold_idle() adds, [idle x passive joints]: J^T W J gains the sum of r^T r.
  std::span<const double> idle() const { return idle_; }

  /// Solves once more for another delta_mu, after a solve that returned true.
  void solve_again(std::span<const double> delta_mu);

  /// Solves J^T W J x = right_side [passive joints], after a solve that returned true.
  void solve_for(std::span<const double> right_side);

  /// The last solution x [passive joints], Eq. 42 (rad, m).
  std::span<const double> solution() const { return solution_; }

 private:
  void weigh(std::span<const lie::Screw<double>> columns, const lie::Matrix6<double>* W);
  void assemble_matrix(std::span<const lie::Screw<double>> columns);
  void assemble_right_side(std::span<const double> delta_mu);
  bool factor();
  void substitute();

  std::vector<LimbPair> pairs_;
  std::vector<std::size_t> limb_of_;  ///< limb of each passive joint
  std::vector<double> coupling_;      ///< [limbs x limbs] signed number of pairs that two limbs form
  std::size_t limbs_;
  std::size_t size_;
  std::size_t idle_freedoms_;
  double reach_;
  std::vector<double> idle_;    ///< [idle x size]
  std::vector<double> matrix_;  ///< [size x size], lower triangle; after factor(): L below, 1 / D on the diagonal
  std::vector<lie::Screw<double>> pull_;      ///< [limbs] signed sum of the residuals of each limb
  std::vector<lie::Screw<double>> weighted_;  ///< W times each column
  std::vector<double> solution_;
};

}  // namespace poesy::chain
