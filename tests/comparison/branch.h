#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/chain/limb.h"

namespace poesy::chain {

/// A branch of roots of J(q)^T W delta_mu(q) = 0. It begins at the root of the perfect mechanism and is followed while
/// all errors grow together.
struct Branch {
  double reached;            ///< factor of the errors at the end of the branch; 1: the full errors
  Eigen::VectorXd delta_mu;  ///< [6 x pairs] the mismatch of the limbs at the end of the branch (rad, m)
  double moved;              ///< largest change of a passive displacement from its nominal value (rad, m)
};

/// Scales all errors from 0 to 1 in steps small enough for plain Newton to contract from each root to the next one. The
/// branch ends where the derivative of -J^T W delta_mu stops being positive definite, as it does at a fold.
/// displacements: [all joints] nominal (rad, m). errors: [frames]. W: the metric; the published method uses the
/// identity.
Branch follow_branch(const ParallelChain& chain, std::span<const double> displacements,
                     std::span<const FrameError<double>> errors, const lie::Matrix6<double>& W);

}  // namespace poesy::chain
