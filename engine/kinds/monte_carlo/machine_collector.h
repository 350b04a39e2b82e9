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

namespace poesy::monte_carlo {

/// Merges units (blocks of machines) in their order. UnitFold (run/unit_fold.h) adds the units to an object of this
/// class. The object keeps a quantile sketch for each response at each pose. Memory hardly grows with the number of
/// machines: by one MachineSums for each octal digit of the number of units (MergeTree), and by one byte for each of
/// the first MachineTable::kept() machines.
class MachineCollector {
 public:
  /// Keeps references to both arguments.
  MachineCollector(const MachineTable& table, const Analysis& analysis);

  void add(std::size_t n, MachineUnit&& unit);  ///< Adds unit n. Precondition: it is the next one.
  /// [responses] The mean of each response over the samples of all poses, with its interval. Machines that are not
  /// solved at every pose are left out. The interval assumes that machines are independent.
  std::vector<Estimate> overall_means() const;
  /// The result of all machines that were added. Precondition: no units are added afterwards.
  Result result() &&;

  /// Reads or writes the sums of the units in this range. Sums that are read are added to those of this object.
  void state(Archive& archive, const NumberRange& units);

 private:
  /// Counts, quantile sketches and lists over machines. Unlike MachineSums they have no rounding, so they need no
  /// MergeTree.
  struct Counts {
    Array<QuantileSketch, axis::Pose, axis::Response> at_pose;
    std::vector<QuantileSketch> largest;  ///< [responses] largest magnitude of each machine
    std::vector<QuantileSketch> rms;      ///< [responses] root mean square of each machine
    std::vector<QuantileSketch> judged;   ///< values by which machines are judged (ValueLimit::deciding), for each
                                          ///< response of MachineTable::judged()
    std::vector<SolveCounts> solves;      ///< [poses] how the solves at each pose ended
    std::vector<FailedSamples> failed;    ///< [poses] first samples that failed at each pose
    std::vector<std::uint8_t> rejected;   ///< 1 if the machine is rejected, otherwise 0, for the first
                                          ///< MachineTable::kept() machines
    MachineCounts machines;
    CalibrationCounts calibration;

    explicit Counts(const MachineTable& table);
    void add(const MachineUnit& unit);
    /// Adds the counts of later machines. Precondition: the machines of `later` come after those of this object.
    void merge(const Counts& later);
    /// Reads or writes the counts of the machines in this range. Throws BytesError.
    void state(Archive& archive, const MachineTable& table, const NumberRange& range);
  };

  std::size_t poses() const { return table_->plan().poses().size(); }
  /// Sets the numbers of a result that follow from the moments and quantile sketches of the samples.
  void set_columns(const MachineSums& sums, Result& found, class MonteCarloColumns& columns) const;
  /// [responses] The values by which machines are judged: the largest magnitude of each machine, or
  /// ValueLimit::deciding() if the limit is not on the magnitude at each pose.
  std::vector<QuantileSketch> judged_values() const;
  MachineResult machines(const MachineSums& sums, std::span<const BinSpread> spreads) const;
  EffectResult effects(const MachineSums& sums, std::span<const BinSpread> spreads) const;

  const MachineTable* table_;
  const Analysis* analysis_;
  MergeTree<MachineSums> sums_;
  Counts counts_;
};

}  // namespace poesy::monte_carlo
