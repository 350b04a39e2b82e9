#pragma once

#include <span>
#include <vector>

#include "models/chain/limb.h"

namespace poesy::chain {

/// How the limbs of a chain disagree, and how its passive joints move them. Plain double arithmetic, one sample at a
/// time. Owns the scratch of one thread.
class Loops {
 public:
  /// The chain must outlive it.
  explicit Loops(const ParallelChain& chain);

  /// frames [chain.frames()]: fixed frames with errors, limb by limb; displacements [chain.joints()] (rad, m). delta_mu
  /// [6 x pairs]: the residual there, [omega; v] in the base frame (rad, m), Eq. 41.
  void evaluate(std::span<const lie::Transform<double>> frames, std::span<const double> displacements,
                std::span<double> delta_mu);

  /// Spatial Jacobian column of each passive joint [passive joints], where the loops were evaluated.
  std::span<const lie::Screw<double>> columns() const { return columns_; }

 private:
  const ParallelChain* chain_;
  std::vector<lie::Transform<double>> poses_;
  std::vector<lie::Screw<double>> columns_;
};

/// Position of each passive joint among all joints.
std::vector<std::size_t> passive_positions(const ParallelChain& chain);

}  // namespace poesy::chain
