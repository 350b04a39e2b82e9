#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/kinds/monte_carlo/machine_table.h"
#include "engine/kinds/monte_carlo/machine_unit.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/stats/merge_tree.h"
#include "engine/stats/quantile_sketch.h"

namespace poesy {

/// Puts units of machines together, in their order, from the first unit of a range on. Holds a sketch of each response
/// at each pose; memory hardly grows with the number of machines, by one sum for each octal digit of it (MergeTree). A
/// last unit that is not whole is kept apart until the end, so that a study with more machines can go on without it.
class MachineCollector {
 public:
  /// units: those of a shard, or all. Refers to the table and the analysis.
  MachineCollector(const MachineTable& table, const Analysis& analysis, const NumberRange& units);

  /// The next unit. Precondition: n is next().
  void add(std::size_t n, MachineUnit&& unit);
  /// The number of the unit that comes next.
  std::size_t next() const;
  SolveCounts total() const;  ///< Over all that was added.
  /// Of each response the mean over the samples of all poses of the whole units, with its interval: machines are what
  /// is independent. Of machines that are solved at each pose.
  std::vector<Estimate> overall_means() const;
  /// Of all machines that were added. Precondition: no more follow.
  MonteCarloResult result() &&;

  /// Everything added so far.
  void write_state(ByteWriter& to) const;
  /// Takes up a state of this range of this study, or of one with fewer machines, of which whole units are taken.
  /// States of consecutive ranges may stand one behind the other. Throws BytesError for anything else. Precondition:
  /// nothing was added.
  void restore(std::span<const std::byte> state);

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
  void restore_one(ByteReader& from);
  /// What follows from the moments and sketches of samples.
  void set_columns(const MachineSums& sums, MonteCarloResult& found, class MonteCarloColumns& columns) const;
  MachineResult machines(const MachineSums& sums, std::span<const BinSpread> spreads) const;
  EffectResult effects(const MachineSums& sums, std::span<const BinSpread> spreads) const;

  const MachineTable* table_;
  const Analysis* analysis_;
  NumberRange units_;
  MergeTree<MachineSums> sums_;      ///< of whole units
  Counts counts_;                    ///< of whole units
  std::optional<MachineUnit> tail_;  ///< the study's last unit where it is not whole
};

}  // namespace poesy
