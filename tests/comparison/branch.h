#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/chain/limb.h"

namespace poesy::chain {

/// The root of J(q)^T W delta_mu(q) = 0 that belongs to perfect parts, followed while the errors grow.
struct Branch {
  double reached;            ///< share of the errors up to which it could be followed; 1 when to its end
  Eigen::VectorXd delta_mu;  ///< [6 x pairs] there
  double moved;              ///< largest change of a passive displacement since zero error (rad, m)
};

/// Scales all errors from 0 to 1 in steps small enough for plain Newton to contract from each root to the next one.
/// The branch ends where the derivative of -J^T W delta_mu stops being positive definite, as it does at a fold.
/// displacements [all joints]: nominal (rad, m); errors [frames]; W: 1 as published.
Branch follow_branch(const ParallelChain& chain, std::span<const double> displacements,
                     std::span<const FrameError<double>> errors, const lie::Matrix6<double>& W);

}  // namespace poesy::chain
