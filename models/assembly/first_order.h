#pragma once

#include <span>
#include <vector>

#include "models/assembly/equilibrium.h"

namespace poesy::assembly {

/// The first-order effects of errors in fixed frames at a pose and, separately, the effects of the load.
class FirstOrder {
 public:
  /// Sets up the equations at the pose. ranks: [limbs] rank of the columns of each limb's passive joints. All arguments
  /// must outlive this object.
  FirstOrder(const Assembly& assembly, const Nominal& pose, std::span<const std::size_t> ranks);

  /// Returns true if the equations have a unique solution.
  bool is_regular() const { return is_regular_; }

  /// The twists of bodies and the wrenches of limbs if errors displace the limbs' ends by the twists xi. xi: six rows
  /// for each limb, a column for each case.
  Balance effect(const Eigen::MatrixXd& xi) const;
  /// The twists and wrenches of the machine without errors, in one column. The load and the mismatch of rounded numbers
  /// cause them.
  const Balance& by_load() const { return by_load_; }

 private:
  const Assembly* assembly_;
  Equilibrium equations_;
  Balance by_load_;
  bool is_regular_;
};

}  // namespace poesy::assembly
