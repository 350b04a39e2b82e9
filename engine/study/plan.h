#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/index.h"
#include "engine/drawing/zone_draws.h"
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
  std::size_t count;  ///< number of samples, B
};

/// A block of correlated errors in a plan.
struct CorrelatedSlots {
  /// Slots of the errors, as positions among the plan's factors.
  std::vector<std::size_t> slots;
  NormalCopula copula;  ///< copula of the factors in this order
};

/// The errors of a feature that are drawn together from its tolerance zone.
struct ZoneSlots {
  /// Slots of the errors, as positions among the plan's factors, in the order of Feature::errors().
  std::vector<std::size_t> slots;
  drawing::ZoneDraws draws;  ///< draws these errors together
};

/// All work of a study with sampled errors. It is an immutable table of work units in the order in which their results
/// are merged. If factors vary one by one, each factor is a slot; if they vary together, all share one slot. The table
/// depends only on the study, never on threads or ranks.
class Plan {
 public:
  /// The largest number of samples in a unit. The bound keeps a unit's memory small.
  static constexpr std::size_t kUnitSamples = 1000;

  /// The number of units that this number of samples of a cell needs. The last unit may be smaller.
  static constexpr std::size_t units_for(std::size_t samples) { return (samples + kUnitSamples - 1) / kUnitSamples; }

  /// Makes the plan of a study of drawn errors at these poses. Copies what it needs. Precondition: the study has a
  /// kind.
  Plan(const Study& study, PoseSet poses);

  /// The number of factors that vary one by one; 1 if all vary together.
  std::size_t slots() const { return slots_; }
  /// The number of cells. A cell is one slot at one pose; cells are counted slot by slot, pose by pose.
  std::size_t cells() const { return slots_ * poses_.size(); }
  std::size_t units_per_cell() const { return units_per_cell_; }   ///< The number of units of one slot at one pose.
  std::size_t units() const { return cells() * units_per_cell_; }  ///< The number of units of the whole plan.
  WorkUnit unit(std::size_t u) const;  ///< The u-th unit. Units go cell by cell, with samples in order.

  /// The first sample of a cell's unit. For the index after the last unit it is the number of samples.
  std::size_t first_sample(std::size_t unit) const { return std::min(unit * kUnitSamples, samples_); }

  std::size_t samples() const { return samples_; }  ///< The largest number of samples in a cell.
  /// The rule by which cells may end before they have samples() samples; none if the number is fixed.
  const std::optional<AdaptiveSamples>& adaptive() const { return adaptive_; }
  Plan with_samples(std::size_t samples) const;  ///< The plan with another number of samples.
  std::uint64_t seed() const { return seed_; }   ///< The seed of the draws.
  Draws draws() const { return draws_; }         ///< Whether errors are drawn for each pose or for each machine.
  /// The slots, ascending, of those errors that a machine draws anew at each pose. The list is empty if draws() is
  /// Draws::per_pose, because then every error is drawn at each pose.
  std::span<const std::size_t> per_pose() const { return per_pose_; }
  /// Returns true if machines draw the factor of this slot anew at each pose.
  bool is_per_pose(std::size_t slot) const;
  /// The address of the draws of factors()[slot] at a pose. A machine uses the draws of the first pose at every pose,
  /// except for its per_pose() errors.
  StreamAddress address(std::size_t slot, PoseIndex pose) const {
    const bool is_fixed = draws_ == Draws::per_machine && !is_per_pose(slot);
    return {seed_, Purpose::error_samples, factors_[slot], is_fixed ? PoseIndex(0) : pose};
  }
  /// Fills a row with the uniforms in [0, 1] from which the errors of factors()[slot] in consecutive samples are
  /// computed. The uniforms of a drawn error come from the stream at its address. The uniforms of an error of given
  /// machines follow from the rank of each value among the values of all machines.
  void draw_uniforms(std::size_t slot, PoseIndex pose, SampleIndex first, std::span<double> row) const;
  const PoseSet& poses() const { return poses_; }  ///< The poses, in the order of the study.
  /// The factors that vary, as positions among the model's factors.
  std::span<const FactorIndex> factors() const { return factors_; }
  /// The distributions of the varied factors, in the order of factors().
  std::span<const Distribution> distributions() const { return distributions_; }
  /// Blocks of correlated errors. Each factor is in at most one block. The errors of a block are either all per_pose()
  /// or none of them. Empty if errors vary one by one.
  std::span<const CorrelatedSlots> correlated() const { return correlated_; }
  /// Returns true if the factor of this slot is in a block of correlated().
  bool is_correlated(std::size_t slot) const;
  /// Features whose errors are drawn together. Each factor is in at most one feature, and never in correlated() as
  /// well. The errors of a feature are either all per_pose() or none of them. Empty if errors vary one by one.
  std::span<const ZoneSlots> zones() const { return zones_; }
  /// Returns true if the factor of this slot is neither correlated nor drawn together with other errors of its feature.
  bool is_drawn_alone(std::size_t slot) const;
  /// Converts uniforms to errors in place. uniforms: [P x B] for P factors and B samples, with a row for each factor in
  /// the order of factors(); they become errors, SI. count: B. The errors of a correlated block, or of a feature,
  /// depend on the uniforms of all factors of the block or feature in the same sample.
  void transform(std::span<double> uniforms, std::size_t count) const;
  /// Converts only the rows of per_pose(), like transform(), and leaves the other rows as they are.
  void transform_per_pose(std::span<double> uniforms, std::size_t count) const;
  /// [F] The constant errors, SI. The value for each varied factor is zero, even while only another factor varies.
  std::span<const double> background() const { return background_; }
  const SolverOptions& solver() const { return solver_; }        ///< The options with which each sample is solved.
  NotConverged not_converged() const { return not_converged_; }  ///< How samples without a solution are treated.
  std::uint64_t solves() const;                                  ///< The number of solves in all units together.

 private:
  /// Transforms the rows of the slots for which is_chosen(slot) is true. Precondition: it is true for all errors of a
  /// block or feature, or for none of them.
  template <class Chosen>
  void transform_if(std::span<double> uniforms, std::size_t count, const Chosen& is_chosen) const;

  PoseSet poses_;
  std::vector<FactorIndex> factors_;
  std::vector<Distribution> distributions_;
  std::vector<CorrelatedSlots> correlated_;
  std::vector<ZoneSlots> zones_;
  std::vector<double> background_;
  std::size_t slots_;
  std::size_t samples_;
  std::optional<AdaptiveSamples> adaptive_;
  std::size_t units_per_cell_;
  std::uint64_t seed_;
  Draws draws_;
  std::vector<std::size_t> per_pose_;
  /// For each of the P factors, the uniforms of given machines; an empty row for an error that is drawn.
  std::vector<std::vector<double>> given_;
  SolverOptions solver_;
  NotConverged not_converged_;
};

/// The numbers of samples in a cell, ascending, after which a study with adaptive samples decides which errors need
/// more. The first is `min` rounded up to whole units (Plan::kUnitSamples). Each further number is 1.5 times the last
/// one, also rounded up, as long as it is below `max`; at `max` itself there is nothing to decide. A larger `max` only
/// extends the list. Empty if the first number is not below `max`.
std::vector<std::size_t> milestones(std::size_t min, std::size_t max);

}  // namespace poesy
