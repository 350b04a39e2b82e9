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

/// Merges units of machines in their order: the sums of a UnitFold. It holds a sketch of each response at each pose.
/// Memory hardly grows with the number of machines, by one sum for each octal digit of that number (MergeTree).
class MachineCollector {
 public:
  /// Refers to both arguments.
  MachineCollector(const MachineTable& table, const Analysis& analysis);

  void add(std::size_t n, MachineUnit&& unit);  ///< Adds the next unit.
  /// The mean of each response over the samples of all poses, with its interval, from machines that are solved at each
  /// pose. The interval takes the machines as independent.
  std::vector<Estimate> overall_means() const;
  /// The result of all machines that were added. Precondition: no units follow.
  MonteCarloResult result() &&;

  /// Reads or writes the sums of these units. What is read is added.
  void state(Archive& archive, const NumberRange& units);

 private:
  /// Sums that do not depend on the order in which they are added.
  struct Counts {
    Array<QuantileSketch, axis::Pose, axis::Response> at_pose;
    std::vector<QuantileSketch> largest;  ///< [R]
    std::vector<QuantileSketch> rms;      ///< [R]
    std::vector<QuantileSketch> judged;   ///< what machines are judged by, for MachineTable::judged()
    std::vector<SolveCounts> solves;      ///< [M]
    std::vector<FailedSamples> failed;    ///< [M]
    std::vector<std::uint8_t> rejected;   ///< 1 or 0 for each machine that MachineTable::kept() counts
    MachineCounts machines;

    explicit Counts(const MachineTable& table);
    void add(const MachineUnit& unit);
    /// Adds those of later machines. Precondition: the machines of `later` come after those of this object.
    void merge(const Counts& later);
    /// Reads or writes the counts of these machines. A writer ignores `range`. Throws BytesError.
    void state(Archive& archive, const MachineTable& table, const NumberRange& range);
  };

  std::size_t poses() const { return table_->plan().poses().size(); }
  /// Sets the numbers that depend on the moments and sketches of the samples.
  void set_columns(const MachineSums& sums, MonteCarloResult& found, class MonteCarloColumns& columns) const;
  /// [R] What machines are judged by; of a response with a plain limit, or with none, their largest magnitudes.
  std::vector<QuantileSketch> judged_values() const;
  MachineResult machines(const MachineSums& sums, std::span<const BinSpread> spreads) const;
  EffectResult effects(const MachineSums& sums, std::span<const BinSpread> spreads) const;

  const MachineTable* table_;
  const Analysis* analysis_;
  MergeTree<MachineSums> sums_;
  Counts counts_;
};

}  // namespace poesy
