#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/kinds/monte_carlo/machine_table.h"
#include "engine/kinds/monte_carlo/machine_unit.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/stats/merge_tree.h"
#include "engine/stats/quantile_sketch.h"

namespace poesy {

/// Puts units of machines together, in their order: the sums of a UnitFold. Holds a sketch of each response at each
/// pose; memory hardly grows with the number of machines, by one sum for each octal digit of it (MergeTree).
class MachineCollector {
 public:
  /// Refers to both.
  MachineCollector(const MachineTable& table, const Analysis& analysis);

  void add(std::size_t n, MachineUnit&& unit);  ///< The next unit.
  /// Of each response the mean over the samples of all poses, with its interval: machines are what is independent. Of
  /// machines that are solved at each pose.
  std::vector<Estimate> overall_means() const;
  /// Of all machines that were added. Precondition: no more follow.
  MonteCarloResult result() &&;

  /// What these units came to. Where it is read, it is added.
  void state(Archive& archive, const NumberRange& units);

 private:
  /// What is counted, so that no order shows in it.
  struct Counts {
    Array<QuantileSketch, axis::Pose, axis::Response> at_pose;
    std::vector<QuantileSketch> largest;  ///< of each response
    std::vector<QuantileSketch> rms;      ///< of each response
    std::vector<SolveCounts> solves;      ///< of each pose
    std::vector<FailedSamples> failed;    ///< of each pose
    std::vector<std::uint8_t> rejected;   ///< of the machines that MachineTable::kept() counts
    MachineCounts machines;

    Counts(std::size_t responses, std::size_t poses);
    void add(const MachineUnit& unit);
    /// Precondition: the machines of `later` come after those of this.
    void merge(const Counts& later);
    /// Of these machines, which nobody looks at where it is written. Throws BytesError.
    void state(Archive& archive, const MachineTable& table, const NumberRange& range);
  };

  std::size_t poses() const { return table_->plan().poses().size(); }
  /// What follows from the moments and sketches of samples.
  void set_columns(const MachineSums& sums, MonteCarloResult& found, class MonteCarloColumns& columns) const;
  MachineResult machines(const MachineSums& sums, std::span<const BinSpread> spreads) const;
  EffectResult effects(const MachineSums& sums, std::span<const BinSpread> spreads) const;

  const MachineTable* table_;
  const Analysis* analysis_;
  MergeTree<MachineSums> sums_;
  Counts counts_;
};

}  // namespace poesy
