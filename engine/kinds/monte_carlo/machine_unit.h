#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/array.h"
#include "engine/kinds/monte_carlo/machine_table.h"
#include "engine/kinds/monte_carlo/part_sums.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/stats/linear_fit.h"
#include "engine/stats/machines.h"
#include "engine/stats/main_effects.h"
#include "engine/stats/moments.h"
#include "engine/stats/number_block.h"
#include "engine/stats/sums.h"
#include "engine/stats/yield_gradient.h"

/// Units of machines and their sums.
namespace poesy {

/// Sums over machines whose last bits depend on the order of addition: a Sum of MergeTree.
struct MachineSums {
  Array<Moments, axis::Pose, axis::Response> at_pose;  ///< moments of the samples that count
  std::vector<Moments> mean;                           ///< [R] of the machines' means over the poses
  std::vector<Moments> largest;                        ///< [R] of the machines' largest magnitudes
  std::vector<Moments> rms;                            ///< [R] of the machines' root mean squares
  std::optional<ScoreSums> scores;                     ///< set if there are limits
  /// Of errors that machines draw anew at each pose, over machines that one pose alone rejects, by the errors at this
  /// pose. Set if there are such errors and limits, which are judged at each pose.
  std::optional<ScoreSums> pose_scores;
  std::optional<LinearFitSums> fit;  ///< fit of the limited vectors at all poses, for the machines that are fitted
  /// [M] The same at each pose alone, instead of `fit`, if machines draw errors anew at each pose; otherwise empty.
  std::vector<std::optional<LinearFitSums>> fit_at_pose;
  std::optional<PartSums> parts;        ///< set if there are limits and errors were measured on parts
  std::vector<MainEffectSums> effects;  ///< [MachineTable::effects()]

  /// Empty sums.
  explicit MachineSums(const MachineTable& table);
  /// Adds later machines. Precondition: the machines of `later` come after those of this object.
  void merge(const MachineSums& later);

  /// The linear map of the limited vectors at all poses, pose by pose; none if too few machines were fitted.
  std::optional<LinearFit> map() const;
  void state(Archive& archive);  ///< Reads or writes every bit.

 private:
  const MachineTable* table_;
};

/// Reads or writes, for each machine of a range that MachineTable::kept() counts, whether it is rejected, 1 or 0.
void rejected_state(Archive& archive, std::vector<std::uint8_t>& rejected, const MachineTable& table,
                    const NumberRange& machines);

/// What one unit of machines contributes.
struct MachineUnit {
  MachineUnit() = default;
  /// An empty unit for this range of machines.
  MachineUnit(const MachineTable& table, const NumberRange& range);

  std::optional<MachineSums> sums;                         ///< empty only in a default-constructed unit
  MachineCounts counts;                                    ///< how many machines are good
  Array<NumberBlock, axis::Pose, axis::Response> at_pose;  ///< the samples that count, sorted for a sketch
  std::vector<NumberBlock> largest;                        ///< [R] of the machines that are solved at each pose
  std::vector<NumberBlock> rms;                            ///< [R] of the machines that are solved at each pose
  std::vector<NumberBlock> judged;                         ///< what machines are judged by, for MachineTable::judged()
  std::vector<std::uint8_t> rejected;  ///< 1 or 0 for each of the machines that MachineTable::kept() counts
  std::vector<SolveCounts> solves;     ///< how the solves at each pose ended
  std::vector<FailedSamples> failed;   ///< the first failed samples at each pose
  SolveCounts total;                   ///< the solves at all poses

  void state(Archive& archive);  ///< Reads or writes the unit as a message or state.

 private:
  const MachineTable* table_ = nullptr;
  NumberRange machines_{};
};

/// Solves units of machines serially: draws their errors once and solves them pose by pose. Owns the scratch of one
/// thread. The result of a unit depends only on the study and the unit.
class MachineUnitEvaluator : private UnitSolver {
 public:
  /// Refers to both arguments.
  MachineUnitEvaluator(const MachineTable& table, const Model& model);

  /// Solves unit n at all poses.
  MachineUnit operator()(std::size_t n);

 private:
  /// Replaces the errors that are drawn anew at each pose, and their bins if effects are summed at this pose.
  void draw_at(const WorkUnit& unit, std::size_t pose, EffectBins& bins);
  void solve_pose(const WorkUnit& unit, std::size_t pose, const EffectBins& bins, MachineBlock& block,
                  MachineUnit& found);
  /// Counts the poses that reject each machine, and keeps the errors that are drawn anew from the first of these.
  void note_rejects(const UnitOutcomes& outcomes, std::span<const std::uint8_t> ok);
  void add_machines(const MachineBlock& block, const EffectBins& bins, MachineUnit& found);
  /// [P x B] The present errors, standardised.
  Array<double, axis::Factor, axis::Sample> standardised(std::size_t machines) const;
  /// Subtracts the mean over the poses from the rows of vectors that are centred.
  void centre_rows();
  /// Fits the limited vectors to these machines, whose rows at all poses are in rows_.
  void add_fit(std::span<const std::uint8_t> solved, MachineUnit& found) const;
  /// The same at one pose, whose samples count where `ok` is 1.
  void add_fit_at(std::size_t pose, std::span<const std::uint8_t> ok, MachineUnit& found) const;
  /// The values whose machine or sample counts.
  std::span<const double> only(std::span<const double> values, std::span<const std::uint8_t> counts);

  const MachineTable* table_;
  std::vector<std::uint8_t> counts_;                 ///< whether each machine counts at the pose
  Array<double, axis::Response, axis::Sample> sum_;  ///< sums over the poses
  std::vector<double> kept_;                         ///< values of one response
  bool is_fitted_ = false;                           ///< whether the present unit is fitted
  Array<double, axis::DetailComponent, axis::Sample>
      details_;  ///< details at the pose, if a limited vector is made of them
  /// Components of the limited vectors, if the unit is fitted.
  Array<double, axis::Pose, axis::VectorRow, axis::Sample> rows_;
  std::vector<std::uint8_t> poses_beyond_;              ///< [B] poses that reject the machine: 0, 1, or 2 for more
  Array<double, axis::Factor, axis::Sample> deciding_;  ///< errors at the first of these poses
};

}  // namespace poesy
