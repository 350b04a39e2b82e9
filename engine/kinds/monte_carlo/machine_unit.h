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

/// Units of machines and what they come to.
namespace poesy {

/// Sums over machines whose order shows in their last bits: a Sum of MergeTree.
struct MachineSums {
  Array<Moments, axis::Pose, axis::Response> at_pose;  ///< of the samples that count
  std::vector<Moments> mean;                           ///< of each response, of the machines' means over the poses
  std::vector<Moments> largest;                        ///< likewise, of the machines' largest magnitudes
  std::vector<Moments> rms;                            ///< likewise, of the machines' root mean squares
  std::optional<ScoreSums> scores;                     ///< where there are limits
  std::optional<LinearFitSums> fit;     ///< of the limited vectors at all poses, over the machines that are fitted
  std::optional<PartSums> parts;        ///< where errors were measured on parts as well
  std::vector<MainEffectSums> effects;  ///< as MachineTable::effects() counts them

  /// Of no machines.
  explicit MachineSums(const MachineTable& table);
  /// Precondition: the machines of `later` come after those of this.
  void merge(const MachineSums& later);

  void state(Archive& archive);  ///< Every bit.

 private:
  const MachineTable* table_;
};

/// Whether each machine of a range that MachineTable::kept() counts is rejected, 1 or 0.
void rejected_state(Archive& archive, std::vector<std::uint8_t>& rejected, const MachineTable& table,
                    const NumberRange& machines);

/// What one unit of machines contributes.
struct MachineUnit {
  MachineUnit() = default;
  /// Of no machines yet, of this range.
  MachineUnit(const MachineTable& table, const NumberRange& range);

  std::optional<MachineSums> sums;                         ///< empty in a default-constructed one alone
  MachineCounts counts;                                    ///< which of them are good
  Array<NumberBlock, axis::Pose, axis::Response> at_pose;  ///< the samples that count, ready for a sketch
  std::vector<NumberBlock> largest;    ///< of each response, of the machines that are solved at each pose
  std::vector<NumberBlock> rms;        ///< likewise
  std::vector<std::uint8_t> rejected;  ///< 1 or 0 for each of the machines that MachineTable::kept() counts
  std::vector<SolveCounts> solves;     ///< how they ended at each pose
  std::vector<FailedSamples> failed;   ///< the first of them at each pose
  SolveCounts total;                   ///< of all poses

  void state(Archive& archive);  ///< For a message or a state.

 private:
  const MachineTable* table_ = nullptr;
  NumberRange machines_{};
};

/// Solves units of machines serially: draws their errors once and solves them pose by pose. Owns the scratch of one
/// thread; what a unit gives depends on the study and the unit.
class MachineUnitEvaluator : private UnitSolver {
 public:
  /// Refers to both.
  MachineUnitEvaluator(const MachineTable& table, const Model& model);

  /// Unit n at all poses.
  MachineUnit operator()(std::size_t n);

 private:
  void solve_pose(const WorkUnit& unit, std::size_t pose, const EffectBins& bins, MachineBlock& block,
                  MachineUnit& found);
  void add_machines(const MachineBlock& block, const EffectBins& bins, MachineUnit& found);
  /// Fits the limited vectors to these machines, whose rows at all poses are in rows_.
  void add_fit(std::span<const std::uint8_t> solved, MachineUnit& found) const;
  /// Those of the values whose machine or sample counts.
  std::span<const double> only(std::span<const double> values, std::span<const std::uint8_t> counts);

  const MachineTable* table_;
  std::vector<std::uint8_t> counts_;                            ///< of the machines at the pose
  Array<double, axis::Response, axis::Sample> sum_;             ///< over the poses
  std::vector<double> kept_;                                    ///< of one response
  bool is_fitted_ = false;                                      ///< the unit at work
  Array<double, axis::DetailComponent, axis::Sample> details_;  ///< at the pose, where a limited vector is made of them
  /// Of the limited vectors, where the unit is fitted.
  Array<double, axis::Pose, axis::VectorRow, axis::Sample> rows_;
};

}  // namespace poesy
