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

/// The smallest piece of scheduled work: consecutive samples of one slot (see Plan) at one pose.
struct WorkUnit {
  std::size_t slot;   ///< index in Plan::factors() of the factor that varies; 0 if all factors vary together
  PoseIndex pose;     ///< index of the pose in the study's list of poses
  SampleIndex first;  ///< index of the first sample of the unit
  std::size_t count;  ///< number of samples
};

/// A block of correlated errors in a plan.
struct CorrelatedSlots {
  /// Indices of the block's errors in Plan::factors().
  std::vector<std::size_t> slots;
  NormalCopula copula;  ///< joint distribution of the errors, in the order of `slots`
};

/// The errors of a feature that are drawn together from its tolerance zone.
struct ZoneSlots {
  /// Indices of the feature's errors in Plan::factors(), in the order of Feature::errors().
  std::vector<std::size_t> slots;
  drawing::ZoneDraws draws;  ///< computes these errors from uniforms
};

/// All work of a study with drawn errors: an immutable table of work units, in the order in which their results are
/// merged. A slot is the set of factors that vary in a unit: a single factor if factors vary one by one, otherwise all
/// factors. A cell is all samples of one slot at one pose; it is divided into units. The table depends only on the
/// study and the poses, never on threads or ranks.
class Plan {
 public:
  /// The largest number of samples in a unit. The bound keeps the memory for a unit small.
  static constexpr std::size_t kUnitSamples = 1000;

  /// The number of units for this number of samples in a cell. The last unit may be smaller.
  static constexpr std::size_t units_for(std::size_t samples) { return (samples + kUnitSamples - 1) / kUnitSamples; }

  /// Makes the plan of a study with drawn errors at these poses. The study need not outlive the plan. Precondition: the
  /// study has a kind.
  Plan(const Study& study, PoseSet poses);

  /// The number of slots: the number of factors if they vary one by one, 1 if all vary together.
  std::size_t slots() const { return slots_; }
  /// The number of cells. Cells are ordered by slot, then by pose.
  std::size_t cells() const { return slots_ * poses_.size(); }
  std::size_t units_per_cell() const { return units_per_cell_; }   ///< The number of units of a cell.
  std::size_t units() const { return cells() * units_per_cell_; }  ///< The number of units of the whole plan.
  /// The u-th unit of the plan. Units are ordered by cell, then by sample.
  WorkUnit unit(std::size_t u) const;

  /// The index of the first sample of the unit with this index in its cell. For the index after the last unit, the
  /// number of samples in a cell.
  std::size_t first_sample(std::size_t unit) const { return std::min(unit * kUnitSamples, samples_); }

  std::size_t samples() const { return samples_; }  ///< The largest number of samples in a cell.
  /// The rule by which cells may end before they have samples() samples; none if the number is fixed.
  const std::optional<AdaptiveSamples>& adaptive() const { return adaptive_; }
  Plan with_samples(std::size_t samples) const;  ///< The same plan with another number of samples in a cell.
  std::uint64_t seed() const { return seed_; }   ///< The seed of the draws.
  Draws draws() const { return draws_; }         ///< Whether errors are drawn for each pose or for each machine.
  /// The indices in factors(), ascending, of those errors that a machine draws anew at each pose. The list is empty if
  /// draws() is Draws::per_pose, because in that case every error is drawn at each pose.
  std::span<const std::size_t> per_pose() const { return per_pose_; }
  /// Returns true if machines draw factors()[slot] anew at each pose. In this function and those below, `slot` is an
  /// index in factors() even if all factors vary together.
  bool is_per_pose(std::size_t slot) const;
  /// The address of the random numbers (the stream) for factors()[slot] at a pose. For an error that a machine does not
  /// draw anew, every pose has the address of the first pose.
  StreamAddress address(std::size_t slot, PoseIndex pose) const {
    const bool is_fixed = draws_ == Draws::per_machine && !is_per_pose(slot);
    return {seed_, Purpose::error_samples, factors_[slot], is_fixed ? PoseIndex(0) : pose};
  }
  /// Fills a row with the uniforms in [0, 1] from which transform() computes the errors of factors()[slot]. first:
  /// index of the first of these consecutive samples. The uniforms of a drawn error come from the stream at its
  /// address(). For an error that given machines state, they follow from the rank of each machine's value among those
  /// of all machines.
  void draw_uniforms(std::size_t slot, PoseIndex pose, SampleIndex first, std::span<double> row) const;
  const PoseSet& poses() const { return poses_; }  ///< The poses, in the order of the study.
  /// The factors that vary, as indices in the model's list of factors.
  std::span<const FactorIndex> factors() const { return factors_; }
  /// The distributions of the varied factors, in the order of factors().
  std::span<const Distribution> distributions() const { return distributions_; }
  /// Blocks of correlated errors. Each factor is in at most one block. The errors of a block are either all per_pose()
  /// or none of them. Empty if errors vary one by one.
  std::span<const CorrelatedSlots> correlated() const { return correlated_; }
  /// Returns true if factors()[slot] is in a block of correlated().
  bool is_correlated(std::size_t slot) const;
  /// Features whose errors are drawn together from a tolerance zone. Each factor is in at most one feature, and then
  /// not in correlated(). The errors of a feature are either all per_pose() or none of them. Empty if errors vary one
  /// by one.
  std::span<const ZoneSlots> zones() const { return zones_; }
  /// Returns true if factors()[slot] is neither correlated nor drawn together with other errors of a feature.
  bool is_drawn_alone(std::size_t slot) const;
  /// Converts uniforms to errors (SI) in place. uniforms: [factors() x count], row-major. In a correlated block, or in
  /// a feature of zones(), each error depends on the uniforms of all errors of the block or feature in the same sample.
  void transform(std::span<double> uniforms, std::size_t count) const;
  /// Does the same as transform(), but only for the rows of the errors in per_pose(); other rows stay unchanged.
  void transform_per_pose(std::span<double> uniforms, std::size_t count) const;
  /// [factors of the model] The values of errors that stay constant, SI. Each error of factors() has 0 here. If a study
  /// varies one error at a time, the others of factors() are then 0.
  std::span<const double> background() const { return background_; }
  const SolverOptions& solver() const { return solver_; }        ///< The options with which each sample is solved.
  NotConverged not_converged() const { return not_converged_; }  ///< How samples without a solution are treated.
  std::uint64_t solves() const;                                  ///< The number of solves of all units.

 private:
  /// Converts the rows for which is_chosen(index of the row) is true. Precondition: for the errors of a block or
  /// feature, it is true for all or for none.
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
  /// [factors()] For an error that given machines state: the uniforms that transform() converts to the machines'
  /// values. Empty for an error that is drawn.
  std::vector<std::vector<double>> given_;
  SolverOptions solver_;
  NotConverged not_converged_;
};

/// The numbers of samples in a cell, ascending, after which a study with adaptive samples decides which errors need
/// more samples. The first is `min` rounded up to whole units (Plan::kUnitSamples). Each further number is 1.5 times
/// the previous one, also rounded up, as long as it is below `max`; at `max` itself there is nothing to decide. A
/// larger `max` only extends the list. The list is empty if the first number is not below `max`.
std::vector<std::size_t> milestones(std::size_t min, std::size_t max);

}  // namespace poesy
