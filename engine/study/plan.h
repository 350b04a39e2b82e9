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

/// The smallest unit of scheduled work: consecutive samples of one slot at one pose.
struct WorkUnit {
  std::size_t slot;   ///< position of the varied factor among the plan's factors; 0 if all vary together
  PoseIndex pose;     ///< position among the study's poses
  SampleIndex first;  ///< the first of consecutive samples
  std::size_t count;  ///< B
};

/// Correlated errors, as the plan has them.
struct CorrelatedSlots {
  std::vector<std::size_t> slots;  ///< positions among the plan's factors
  NormalCopula copula;             ///< copula of the factors in this order
};

/// The expanded study of sampled errors: an immutable table of work units in the order in which they are merged. A
/// factor that varies alone is a slot; factors that vary together are one slot. The table depends only on the study,
/// never on threads or ranks.
class Plan {
 public:
  /// The largest number of samples in a unit; it bounds the memory of a unit.
  static constexpr std::size_t kUnitSamples = 1000;

  /// The number of units for this many samples of a cell. The last unit may be smaller.
  static constexpr std::size_t units_for(std::size_t samples) { return (samples + kUnitSamples - 1) / kUnitSamples; }

  /// The plan of a study of drawn errors at these poses. Copies what it needs. Precondition: the study has a kind.
  Plan(const Study& study, PoseSet poses);

  std::size_t slots() const {
    return slots_;
  }  ///< The number of factors that are studied one by one; 1 if all vary together.
  /// The number of cells. A cell is one slot at one pose; cells are counted slot by slot, pose by pose.
  std::size_t cells() const { return slots_ * poses_.size(); }
  std::size_t units_per_cell() const { return units_per_cell_; }   ///< The number of units of one slot at one pose.
  std::size_t units() const { return cells() * units_per_cell_; }  ///< The number of units of the whole plan.
  WorkUnit unit(std::size_t u) const;  ///< The u-th unit, cell by cell, with samples in order.

  /// The first sample of a cell's unit. For the unit after the last it is the number of samples.
  std::size_t first_sample(std::size_t unit) const { return std::min(unit * kUnitSamples, samples_); }

  std::size_t samples() const { return samples_; }  ///< The largest number of samples of one slot at each pose.
  /// The rule by which a study may end before each cell has samples(); none for a fixed number.
  const std::optional<AdaptiveSamples>& adaptive() const { return adaptive_; }
  Plan with_samples(std::size_t samples) const;  ///< The plan with another number of samples.
  std::uint64_t seed() const { return seed_; }   ///< The seed of the draws.
  Draws draws() const { return draws_; }         ///< Whether errors are drawn for each pose or for each machine.
  /// The positions among factors(), ascending, of errors that machines draw anew at each pose. Empty if draws() is per
  /// pose, because all errors are then drawn so.
  std::span<const std::size_t> per_pose() const { return per_pose_; }
  bool is_per_pose(std::size_t slot) const;  ///< Whether machines draw the factor of this slot anew at each pose.
  /// The address of the draws of factors()[slot] at a pose. A machine has the draws of the first pose at every pose,
  /// but of its per_pose() errors those of the pose.
  StreamAddress address(std::size_t slot, PoseIndex pose) const {
    const bool is_fixed = draws_ == Draws::per_machine && !is_per_pose(slot);
    return {seed_, Purpose::error_samples, factors_[slot], is_fixed ? PoseIndex(0) : pose};
  }
  /// Fills a row with the uniforms of consecutive samples, from which the errors of factors()[slot] are computed: those
  /// of its address, or of given machines the places of their values among all rows.
  void draw_uniforms(std::size_t slot, PoseIndex pose, SampleIndex first, std::span<double> row) const;
  const PoseSet& poses() const { return poses_; }  ///< The poses, in the order of the study.
  std::span<const FactorIndex> factors() const {
    return factors_;
  }  ///< The factors that vary, as positions in the model's list.
  /// The distribution of each varied factor, in the order of factors().
  std::span<const Distribution> distributions() const { return distributions_; }
  /// Blocks of correlated errors. No factor is in two of them, and either all or none of a block are per_pose(). Empty
  /// if errors vary one by one.
  std::span<const CorrelatedSlots> correlated() const { return correlated_; }
  bool is_correlated(std::size_t slot) const;  ///< Whether the factor of this slot is in such a block.
  /// Replaces the uniforms of all factors, [P x B] in the order of factors(), by errors, SI. Each factor uses the
  /// uniforms of its own address; a correlated one also uses those of the others in its block, of the same sample.
  void transform(std::span<double> uniforms, std::size_t count) const;
  /// The same for the rows of per_pose() alone; the others are left as they are.
  void transform_per_pose(std::span<double> uniforms, std::size_t count) const;
  /// [F] Constant errors; zero for those that vary, even while only another one varies.
  std::span<const double> background() const { return background_; }
  const SolverOptions& solver() const { return solver_; }        ///< The solver of each sample.
  NotConverged not_converged() const { return not_converged_; }  ///< How samples that are not solved are treated.
  std::uint64_t solves() const;                                  ///< The solves of all units together.

 private:
  /// Transforms the rows of the slots that are chosen. Precondition: all or none of a correlated block.
  template <class Chosen>
  void transform_if(std::span<double> uniforms, std::size_t count, const Chosen& is_chosen) const;

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
  std::vector<std::size_t> per_pose_;
  std::vector<std::vector<double>> given_;  ///< [P][rows] uniforms of given machines; empty for errors that are drawn
  SolverOptions solver_;
  NotConverged not_converged_;
};

/// The numbers of samples at a pose at which a study with adaptive samples decides what goes on, ascending: `min`
/// rounded up to whole units (Plan::kUnitSamples), then each 1.5 times the last, also rounded up, while they are below
/// `max`. A larger max only extends the list. At max itself nothing is left to decide. Empty if the first one is not
/// below max.
std::vector<std::size_t> milestones(std::size_t min, std::size_t max);

}  // namespace poesy
