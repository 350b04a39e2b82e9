#pragma once

#include <span>
#include <vector>

#include "models/chain/limb.h"

namespace poesy::chain {

/// The mismatch of the limbs of a chain, and the Jacobian columns of its passive joints. Uses plain double arithmetic,
/// one sample at a time. An object has scratch memory, so each thread needs its own object.
class Loops {
 public:
  /// The chain must outlive this object.
  explicit Loops(const ParallelChain& chain);

  /// Computes the residual delta_mu [6 x pairs], [omega; v] in the base frame (rad, m), Eq. 41 of Du et al. 2022.
  /// frames: [chain.frames()] fixed frames with errors, limb by limb. displacements: [chain.joints()] (rad, m).
  void evaluate(std::span<const lie::Transform<double>> frames, std::span<const double> displacements,
                std::span<double> delta_mu);

  /// [passive joints] The spatial Jacobian columns for the arguments of the last evaluate().
  std::span<const lie::Screw<double>> columns() const { return columns_; }

 private:
  const ParallelChain* chain_;
  std::vector<lie::Transform<double>> poses_;
  std::vector<lie::Screw<double>> columns_;
};

/// [passive joints] The index of each passive joint among the joints of all limbs.
std::vector<std::size_t> passive_positions(const ParallelChain& chain);

}  // namespace poesy::chain
