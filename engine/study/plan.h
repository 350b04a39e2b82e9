#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/index.h"
#include "engine/random/distribution.h"
#include "engine/random/normal_copula.h"
#include "engine/random/stream.h"
#include "engine/study/study.h"

namespace poesy {

/// The smallest piece of work that is scheduled: consecutive samples of one slot at one pose.
struct WorkUnit {
  std::size_t slot;   ///< position of the varied factor among the plan's factors; 0 where all vary together
  PoseIndex pose;     ///< among the study's
  SampleIndex first;  ///< the first of consecutive samples
  std::size_t count;  ///< B
};

/// Errors that depend on each other, as the plan knows them.
struct CorrelatedSlots {
  std::vector<std::size_t> slots;  ///< positions among the plan's factors
  NormalCopula copula;             ///< in this order
};

/// A study of sampled errors, expanded: an immutable table of work units in the order in which they are merged. A
/// factor that varies alone is a slot; factors that vary together are one slot.
/// The table depends on the study alone, never on threads or ranks.
class Plan {
 public:
  /// A unit never holds more samples than this, so that memory per unit is bounded.
  static constexpr std::size_t kUnitSamples = 1000;

  /// Units that so many samples of a cell make up, the last one perhaps smaller.
  static constexpr std::size_t units_for(std::size_t samples) { return (samples + kUnitSamples - 1) / kUnitSamples; }

  /// Of a study of drawn errors, at these poses. Copies what it needs. Precondition: the study has a kind.
  Plan(const Study& study, PoseSet poses);

  std::size_t slots() const { return slots_; }  ///< Factors that are studied one by one; 1 where all vary together.
  /// A cell is one slot at one pose. Cells are counted slot by slot, pose by pose.
  std::size_t cells() const { return slots_ * poses_.size(); }
  std::size_t units_per_cell() const { return units_per_cell_; }   ///< Units of one slot at one pose.
  std::size_t units() const { return cells() * units_per_cell_; }  ///< Of the whole plan.
  WorkUnit unit(std::size_t u) const;                              ///< Unit u: cell by cell, samples in order.

  /// The first sample of a cell's unit; the number of samples for the unit after the last.
  std::size_t first_sample(std::size_t unit) const { return std::min(unit * kUnitSamples, samples_); }

  std::size_t samples() const { return samples_; }  ///< At each pose, of one slot.
  /// How a study may come to an end before each cell has samples().
  const std::optional<AdaptiveSamples>& adaptive() const { return adaptive_; }
  Plan with_samples(std::size_t samples) const;  ///< The same with another number of samples.
  std::uint64_t seed() const { return seed_; }   ///< Of the draws.
  Draws draws() const { return draws_; }         ///< Where they are made anew.
  /// Of the draws of factors()[slot] at a pose. A machine has the draws of the first pose at every pose.
  StreamAddress address(std::size_t slot, PoseIndex pose) const {
    return {seed_, Purpose::error_samples, factors_[slot], draws_ == Draws::per_machine ? PoseIndex(0) : pose};
  }
  const PoseSet& poses() const { return poses_; }                    ///< In the order of the study.
  std::span<const FactorIndex> factors() const { return factors_; }  ///< That vary, positions in the model's list.
  /// Distribution of each varied factor, in the order of factors().
  std::span<const Distribution> distributions() const { return distributions_; }
  /// Blocks of errors that depend on each other; a factor is in one at the most. Empty where errors vary one by one.
  std::span<const CorrelatedSlots> correlated() const { return correlated_; }
  bool is_correlated(std::size_t slot) const;  ///< Whether the factor of this slot is in such a block.
  /// Replaces the uniforms of all factors, [P x B] in the order of factors(), by errors, SI. Each factor takes the
  /// uniforms of its own address; one that is correlated with others takes theirs too, of the same sample.
  void transform(std::span<double> uniforms, std::size_t count) const;
  /// Constant errors, [F]; zero for those that vary, also while another one does.
  std::span<const double> background() const { return background_; }
  const SolverOptions& solver() const { return solver_; }        ///< For each sample.
  NotConverged not_converged() const { return not_converged_; }  ///< What becomes of samples that are not solved.
  std::uint64_t solves() const;                                  ///< Of all units together.

 private:
  PoseSet poses_;
  std::vector<FactorIndex> factors_;
  std::vector<Distribution> distributions_;
  std::vector<CorrelatedSlots> correlated_;
  std::vector<double> background_;
  std::size_t slots_;
  std::size_t samples_;
  std::optional<AdaptiveSamples> adaptive_;
  std::size_t units_per_cell_;
  std::uint64_t seed_;
  Draws draws_;
  SolverOptions solver_;
  NotConverged not_converged_;
};

/// The numbers of samples at a pose at which a study with adaptive samples decides what goes on, ascending: `min`
/// rounded up to whole units (Plan::kUnitSamples), then each 1.5 times the last, rounded up likewise, as far as they
/// are below `max`. A larger max only adds to the list. At max itself nothing is left to decide. Empty where the first
/// is not below max.
std::vector<std::size_t> milestones(std::size_t min, std::size_t max);

}  // namespace poesy
