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

namespace poesy {

/// Collects the global indices of a sensitivity study at its history points (engine/run/evaluate_unit.h) while units
/// are merged. When all poses of a slot have reached a point, it computes the indices there and drops the data of the
/// poses. Cells are solved slot by slot, so the data of one slot are in memory at a time: 16 bytes for each response,
/// pose and point. A continued run or a shard also holds those of the slots that it divides.
class HistoryCollector {
 public:
  /// Refers to the plan.
  HistoryCollector(const Plan& plan, std::size_t responses, double conf_level);

  /// Adds the next unit of its cell. cell: the statistics of the cell's samples including this unit. It is needed only
  /// if the unit ends at a history point; a smaller last unit does so only if it is the first of its cell.
  void add(const WorkUnit& unit, std::span<const LocalIndex> within, const UnitStats& cell);
  /// The indices at all points. Precondition: all units of all cells were added. end: the final result.
  EstimateCourse history(const SensitivityResult& end) const;

  /// Writes the points, or reads those of a plan with this many samples (at most those of this plan) and of other
  /// cells, and adds them. units_done: the number of units in each cell.
  void state(Archive& archive, std::span<const std::size_t> units_done, std::size_t samples);

 private:
  /// One slot at one point.
  struct Look {
    std::size_t reached = 0;                                   ///< number of poses that have reached the point
    Array<LocalIndex, axis::Response, axis::Pose> local = {};  ///< kept while some poses have not reached the point
    std::vector<Estimate> global = {};                         ///< [R] set when all poses have reached the point
  };
  struct Point {
    static constexpr std::string_view kName = "samples";
  };

  std::size_t poses() const { return plan_->poses().size(); }
  /// indices: [R]
  void add(std::size_t cell, std::size_t point, std::span<const LocalIndex> indices);
  /// The poses of the slot whose units include this point; units_done: [cells].
  std::vector<std::size_t> poses_at(std::size_t slot, std::size_t point, std::span<const std::size_t> units_done) const;

  const Plan* plan_;
  std::size_t responses_;
  double conf_level_;
  std::vector<std::size_t> points_;  ///< [K]
  Array<Look, axis::Factor, Point> looks_;
};

/// Merges the units of a sensitivity study, cell by cell: the sums of a PoseFold. The result of a cell depends only on
/// the order of its own units.
class SensitivityCollector : public CellSums<CellStats> {
 public:
  /// Collects the cells of this shard of the plan. Refers to the plan.
  SensitivityCollector(const Plan& plan, std::size_t responses, double conf_level, const Shard& shard = Shard());

  /// Adds a unit. Precondition: it is the next unit of its cell.
  void add(const WorkUnit& unit, const CellUnit& found);
  /// The course of the indices, which ends with those of `end`. Precondition: all units of all cells were added, and
  /// the study has a fixed number of samples.
  EstimateCourse history(const SensitivityResult& end) const { return history_.history(end); }
  /// Writes all cells, or reads those of a plan with this many samples and adds them.
  void state(Archive& archive, std::size_t samples);

 private:
  HistoryCollector history_;
};

}  // namespace poesy
