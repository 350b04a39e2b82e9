#pragma once

#include <span>
#include <vector>

#include "models/chain/limb.h"

namespace poesy::chain {

/// The mismatch of the limbs of a chain, and the Jacobian columns of its passive joints. Plain double arithmetic, one
/// sample at a time. Owns the scratch of one thread.
class Loops {
 public:
  /// The chain must outlive it.
  explicit Loops(const ParallelChain& chain);

  /// Computes delta_mu [6 x pairs], the residual [omega; v] in the base frame (rad, m), Eq. 41. frames
  /// [chain.frames()]: fixed frames with errors, limb by limb; displacements [chain.joints()] (rad, m).
  void evaluate(std::span<const lie::Transform<double>> frames, std::span<const double> displacements,
                std::span<double> delta_mu);

  /// Spatial Jacobian columns [passive joints] at the arguments of the last evaluate().
  std::span<const lie::Screw<double>> columns() const { return columns_; }

 private:
  const ParallelChain* chain_;
  std::vector<lie::Transform<double>> poses_;
  std::vector<lie::Screw<double>> columns_;
};

/// Position of each passive joint among all joints.
std::vector<std::size_t> passive_positions(const ParallelChain& chain);

}  // namespace poesy::chain
