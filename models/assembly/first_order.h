#pragma once

#include <span>
#include <vector>

#include "models/assembly/equilibrium.h"

namespace poesy::assembly {

/// What entries of frames' errors do to first order at a pose, beside the load.
class FirstOrder {
 public:
  /// Equations at the pose. ranks: of each limb's passive columns, [limbs]. All must outlive it.
  FirstOrder(const Assembly& assembly, const Nominal& pose, std::span<const std::size_t> ranks);

  /// Whether the equations have a unique solution.
  bool is_regular() const { return is_regular_; }

  /// The bodies' twists and the limbs' wrenches by twists of limbs' ends, [6 limbs x k].
  Balance effect(const Eigen::MatrixXd& xi) const;
  /// The same of the load alone, and of the mismatch that rounded numbers leave, one column.
  const Balance& by_load() const { return by_load_; }

 private:
  const Assembly* assembly_;
  Equilibrium equations_;
  Balance by_load_;
  bool is_regular_;
};

}  // namespace poesy::assembly
