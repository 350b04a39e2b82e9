#pragma once

#include <optional>
#include <span>
#include <vector>

#include "models/assembly/loops.h"
#include "models/assembly/model.h"

namespace poesy::assembly {

/// Returns true if this mismatch [limbs], measured by the metric of the platform's points, is more than rounding.
bool is_open(const AssemblyModel& model, const Nominal& pose, std::span<const Screw> mismatch);

/// Decides whether the loops of an assembly with errors can be closed at all, if its limbs deform each other. For limbs
/// that do not deform each other, Continuation decides. Bodies and passive joints descend from the nominal pose to the
/// configuration at which the sum of |xi|_W^2 over the limbs is least; xi is the mismatch of a limb, and W the metric
/// of the platform's points. Let r be the part of the remaining mismatch that bodies and joints of the perfect assembly
/// could take away. N = B^T W B, with B as in Loops but in this configuration, and C(r) is the matrix of bend()
/// (loops.h). The machine cannot be assembled if N - 2 C(r) is not positive definite. This is the rule of
/// chain::Assembly; stiffness has no influence on it.
///
/// Uses plain double arithmetic. The class is meant for two sorts of samples: those that a solver did not solve, and
/// those with errors that may open a loop.
class Closure {
 public:
  /// Decides for machines at this pose. Both arguments must outlive this object.
  Closure(const AssemblyModel& model, const Nominal& pose) : model_(&model), pose_(&pose) {}

  /// Computes the first-order change of ln det N by the errors of each sample. If the change is below the negative
  /// number chain::kNearing, a loop may open, so that the machine may be impossible to assemble. nearing: receives a
  /// number for each sample. The result is 0 if the loops without errors are singular. It is also 0 if limbs cannot
  /// hold a loop open, because they have no stiffness and do not deform each other.
  void find_nearing(const SampleBlock& samples, std::span<double> nearing);

  /// Returns true if errors may open a loop. nearing: from find_nearing().
  static bool may_open(double nearing);

  /// Returns true if the errors of a machine may open a loop and the machine cannot be assembled. nearing: from
  /// find_nearing(). frames: fixed frames of each limb, with errors.
  bool opens(double nearing, std::span<const std::vector<Transform>> frames) {
    return may_open(nearing) && is_impossible(frames);
  }

  /// The status of a sample for which Solver returned `found`. It is not_assembled instead of found.status in two
  /// cases: if Solver did not solve the sample and is_impossible() is true, and if a mismatch remains in the solution
  /// although limbs cannot hold a loop open. frames: as for opens().
  SolveStatus judged(const Solution& found, std::span<const std::vector<Transform>> frames);

  /// Returns true if a machine cannot be assembled. frames: as for opens(). Returns false if the descent does not come
  /// to rest, or if the loops without errors are singular.
  bool is_impossible(std::span<const std::vector<Transform>> frames);

  /// Returns true if the loops without errors are regular. The first call computes these loops, and the first-order
  /// change of ln det N (class comment) per unit of each error.
  bool is_regular();

 private:
  bool may_hold_open() const { return model_->over_constrained || model_->assembly.metric == Metric::stiffness; }

  const AssemblyModel* model_;
  const Nominal* pose_;
  std::optional<Loops> loops_;   ///< loops without errors, computed when they are first needed
  std::vector<double> nearing_;  ///< [errors] first-order change of ln det N per unit of each error
};

}  // namespace poesy::assembly
