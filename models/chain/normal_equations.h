#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "models/chain/limb.h"

namespace poesy::chain {

/// The normal equations J^T W J x = J^T W delta_mu, which for W = 1 are Eq. 44 of Du et al. 2022. They are computed
/// from the columns of the passive joints. The matrix J of Eq. 43, which repeats a column for every pair that contains
/// the limb, is never formed.
class NormalEquations {
 public:
  /// Allocates scratch memory for chains with the limbs, joints and pairs of this chain.
  explicit NormalEquations(const ParallelChain& chain);

  /// Solves for the changes x of the passive displacements. columns: [passive joints]. delta_mu: [6 x pairs]. W: null
  /// for W = 1. damping: the diagonal of J^T W J is multiplied by 1 + damping. Returns false if a pivot falls to
  /// rounding relative to its diagonal entry; the solution is then undefined.
  bool solve(std::span<const lie::Screw<double>> columns, std::span<const double> delta_mu,
             const lie::Matrix6<double>* W = nullptr, double damping = 0.0);

  /// [passive joints x passive joints] The matrix J^T W J of the normal equations plus the terms of hold_idle().
  /// Arguments as for solve().
  Eigen::MatrixXd matrix(std::span<const lie::Screw<double>> columns, const lie::Matrix6<double>* W);

  /// Makes J^T W J regular from now on, although idle freedoms (ParallelChain::idle) make it singular. Each idle
  /// freedom is a combination of these columns [passive joints] that does not move the platform; for each, r^T r is
  /// added to the matrix, where the row r is the unit direction of this combination times the root mean square of the
  /// norms |c|_W of the columns c.
  void hold_idle(std::span<const lie::Screw<double>> columns, const lie::Matrix6<double>* W);
  /// [idle freedoms x passive joints] The rows r of the idle freedoms. The sum of r^T r is added to J^T W J; see
  /// hold_idle().
  std::span<const double> idle() const { return idle_; }

  /// Solves for another delta_mu with the same matrix, after a solve that returned true.
  void solve_again(std::span<const double> delta_mu);

  /// Solves J^T W J x = right_side [passive joints] with the same matrix, after a solve that returned true.
  void solve_for(std::span<const double> right_side);

  /// [passive joints] The last solution x (rad, m), Eq. 42 of Du et al. 2022.
  std::span<const double> solution() const { return solution_; }

 private:
  void weigh(std::span<const lie::Screw<double>> columns, const lie::Matrix6<double>* W);
  void assemble_matrix(std::span<const lie::Screw<double>> columns);
  void assemble_right_side(std::span<const double> delta_mu);
  bool factor();
  void substitute();

  std::vector<LimbPair> pairs_;
  std::vector<std::size_t> limb_of_;  ///< limb of each passive joint
  std::vector<double> coupling_;  ///< [limbs x limbs] diagonal: number of pairs with this limb; else: minus number of
                                  ///< pairs of the two limbs
  std::size_t limbs_;
  std::size_t size_;
  std::size_t idle_freedoms_;
  double reach_;
  std::vector<double> idle_;    ///< [idle x size] rows r of hold_idle()
  std::vector<double> matrix_;  ///< [size x size] lower triangle of J^T W J; factor() replaces it by its factors L D
                                ///< L^T: L below the diagonal, 1 / D on it
  std::vector<lie::Screw<double>> pull_;      ///< [limbs] sum of the residuals of each limb's pairs: added if the limb
                                              ///< is i of the pair, subtracted if it is k
  std::vector<lie::Screw<double>> weighted_;  ///< weight matrix W times each column
  std::vector<double> solution_;
};

}  // namespace poesy::chain
