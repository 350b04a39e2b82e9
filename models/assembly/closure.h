#pragma once

#include <optional>
#include <span>
#include <vector>

#include "models/assembly/loops.h"
#include "models/assembly/model.h"

namespace poesy::assembly {

/// Whether the loops of an assembly with errors can be closed at all: bodies and passive joints go downhill from the
/// nominal pose to where the limbs' mismatch is least, sum of |xi|_W^2. With r the part of the mismatch that is left
/// there and that bodies and joints could take away from the perfect assembly, and C(r) what it adds to N = B^T W B
/// (bend), a machine cannot be assembled where N - 2 C(r) is not positive definite: the rule of chain::Assembly.
/// Stiffness plays no part in it.
///
/// Plain double arithmetic, for samples that a solver did not solve or whose errors bring loops near their end.
class Closure {
 public:
  /// At this pose. Both must outlive it.
  Closure(const AssemblyModel& model, const Nominal& pose) : model_(&model), pose_(&pose) {}

  /// The first-order change of ln det N by the errors of each sample, [B]: machines with less than chain::kNearing may
  /// be ones that cannot be assembled. 0 where the perfect loops are singular.
  void find_nearing(const SampleBlock& samples, std::span<double> nearing);

  /// Whether this mismatch [limbs] is more than rounding.
  bool is_open(std::span<const Screw> mismatch) const;

  /// frames: of each limb with errors, [limbs][n + 1]. False where the way down comes to no end, and where the perfect
  /// loops are singular.
  bool is_impossible(std::span<const std::vector<Transform>> frames);

 private:
  bool is_regular();

  const AssemblyModel* model_;
  const Nominal* pose_;
  std::optional<Loops> loops_;   ///< once asked for
  std::vector<double> nearing_;  ///< [F] of a unit of each error
};

}  // namespace poesy::assembly
