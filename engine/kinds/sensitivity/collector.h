#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/kinds/sensitivity/cell_stats.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/pose_fold.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/stats/indices.h"
#include "engine/study/plan.h"

namespace poesy::sensitivity {

/// Computes, while units are merged, how the global indices of a sensitivity study develop with the number of samples.
/// The indices are computed at the history points, which are fixed numbers of samples such as 100, 200 and 500
/// (history_points() in engine/run/evaluate_unit.h). When all poses of an error have reached a point, the global
/// indices there are computed and the local indices are dropped. Errors are solved one after the other, so only the
/// data of one error are in memory: 16 bytes for each response, pose and point. A continued run or a shard may also
/// hold the data of errors for which it has only some of the poses.
class HistoryCollector {
 public:
  /// Keeps a reference to the plan.
  HistoryCollector(const Plan& plan, std::size_t responses, double conf_level);

  /// Adds the next unit of a cell (one error at one pose). within: [points x responses] local indices at the history
  /// points inside the unit. cell: statistics of all samples of the cell up to the end of this unit; only used if the
  /// unit ends at a history point. A unit with fewer samples than a full unit ends at a history point only if it is the
  /// only unit of its cell.
  void add(const WorkUnit& unit, std::span<const LocalIndex> within, const UnitStats& cell);
  /// The indices at all history points, ending with the final result `end`. Precondition: all units of all cells were
  /// added.
  EstimateCourse history(const Result& end) const;

  /// Writes the indices at all history points, or reads them and adds them to those of this object. samples: number of
  /// samples of the study that wrote them, at most the number of this study. units_done: [cells] number of units of
  /// each cell.
  void state(Archive& archive, std::span<const std::size_t> units_done, std::size_t samples);

 private:
  /// The indices of one error at one history point, as far as they are known.
  struct Look {
    std::size_t reached = 0;  ///< number of poses that have reached the history point
    /// Local indices at the poses that have reached the point; empty once all poses have.
    Array<LocalIndex, axis::Response, axis::Pose> local = {};
    /// [responses] Global indices; empty until all poses have reached the point.
    std::vector<Estimate> global = {};
  };
  struct Point {
    static constexpr std::string_view kName = "samples";
  };

  std::size_t poses() const { return plan_->poses().size(); }
  /// Adds the local indices [responses] of a cell at a history point.
  void add(std::size_t cell, std::size_t point, std::span<const LocalIndex> indices);
  /// The poses at which an error has reached this history point. slot: position of the error in the plan's factors().
  /// units_done: [cells] number of units of each cell.
  std::vector<std::size_t> poses_at(std::size_t slot, std::size_t point, std::span<const std::size_t> units_done) const;

  const Plan* plan_;
  std::size_t responses_;
  double conf_level_;
  std::vector<std::size_t> points_;  ///< [points] numbers of samples of the history points
  Array<Look, axis::Factor, Point> looks_;
};

/// Merges the units of a sensitivity study, cell by cell; a cell is one error at one pose. PoseFold (run/pose_fold.h)
/// adds the units to an object of this class. The result of a cell depends only on the order of its own units.
class Collector : public CellSums<CellStats> {
 public:
  /// Collects the cells of this shard of the plan. Keeps a reference to the plan.
  Collector(const Plan& plan, std::size_t responses, double conf_level, const Shard& shard = Shard());

  /// Adds a unit. Precondition: it is the next unit of its cell.
  void add(const WorkUnit& unit, const CellUnit& found);
  /// The indices at the history points, ending with those of `end`. Precondition: all units of all cells were added,
  /// and the study has a fixed number of samples.
  EstimateCourse history(const Result& end) const { return history_.history(end); }
  /// Writes the statistics of all cells; or reads those that a study with `samples` samples at each pose wrote, and
  /// adds them.
  void state(Archive& archive, std::size_t samples);

 private:
  HistoryCollector history_;
};

}  // namespace poesy::sensitivity
