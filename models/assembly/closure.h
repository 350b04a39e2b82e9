#pragma once

#include <span>
#include <vector>

#include "models/assembly/nominal.h"

namespace poesy::assembly {

/// Whether the loops of an assembly with errors can be closed at all, where errors deform nothing: bodies and passive
/// joints go downhill from the nominal pose to where the limbs' mismatch is least, sum of |xi|_W^2, and a mismatch that
/// stays there means that nobody can put the machine together. Plain double arithmetic, for samples that a solver did
/// not solve.
///
/// Not for over-constrained assemblies, in which a mismatch stays in every machine.
class Closure {
 public:
  explicit Closure(const Assembly& assembly) : assembly_(&assembly) {}  ///< The assembly must outlive it.

  /// Whether this mismatch [limbs] is more than rounding.
  bool is_open(const Nominal& pose, std::span<const Screw> mismatch) const;

  /// frames: of each limb with errors, [limbs][n + 1]. False where the way down comes to no end.
  bool is_impossible(const Nominal& pose, std::span<const std::vector<Transform>> frames) const;

 private:
  const Assembly* assembly_;
};

}  // namespace poesy::assembly
