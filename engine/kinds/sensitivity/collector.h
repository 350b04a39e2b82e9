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

/// What the global indices of a sensitivity study were at its history points
/// (engine/run/evaluate_unit.h), put together as units are merged. As soon as all poses of a slot have
/// reached a point, its indices are computed and what the poses had is dropped: as cells are solved slot by slot, that
/// of one slot is in memory at a time, 16 bytes for each response, pose and point. A continued run, and a shard, also
/// holds that of the slots that it cuts.
class HistoryCollector {
 public:
  /// Refers to the plan.
  HistoryCollector(const Plan& plan, std::size_t responses, double conf_level);

  /// The unit after those added in its cell. cell: what the cell's samples came to with it; it is needed only where the
  /// unit ends at a history point, which is never one of a smaller last unit but the cell's first.
  void add(const WorkUnit& unit, std::span<const LocalIndex> within, const UnitStats& cell);
  /// Precondition: all units of all cells were added. end: what they came to.
  EstimateCourse history(const SensitivityResult& end) const;

  /// What was added, in cells that hold so many units each. Where it is read, it is of a plan with so many samples, at
  /// most this one's, and of other cells than those that were added.
  void state(Archive& archive, std::span<const std::size_t> units_done, std::size_t samples);

 private:
  /// One slot at one point.
  struct Look {
    std::size_t reached = 0;                                   ///< poses
    Array<LocalIndex, axis::Response, axis::Pose> local = {};  ///< while some poses have reached it, others not
    std::vector<Estimate> global = {};                         ///< [R] once all have
  };
  struct Point {
    static constexpr std::string_view kName = "samples";
  };

  std::size_t poses() const { return plan_->poses().size(); }
  /// indices: [R]
  void add(std::size_t cell, std::size_t point, std::span<const LocalIndex> indices);
  /// The slot's poses with the units that this point is in; units_done: [cells].
  std::vector<std::size_t> poses_at(std::size_t slot, std::size_t point, std::span<const std::size_t> units_done) const;

  const Plan* plan_;
  std::size_t responses_;
  double conf_level_;
  std::vector<std::size_t> points_;  ///< [K]
  Array<Look, axis::Factor, Point> looks_;
};

/// Puts the units of a sensitivity study together, cell by cell: the sums of a PoseFold. What a cell becomes depends on
/// the order of its own units alone.
class SensitivityCollector : public CellSums<CellStats> {
 public:
  /// Of the cells that this shard of the plan has: no others are added. Refers to the plan.
  SensitivityCollector(const Plan& plan, std::size_t responses, double conf_level, const Shard& shard = Shard());

  /// Precondition: the unit after those done in its cell.
  void add(const WorkUnit& unit, const CellUnit& found);
  /// Of the indices, whose last are those of `end`. Precondition: all units were added, those of all cells; the study
  /// has a fixed number of samples.
  EstimateCourse history(const SensitivityResult& end) const { return history_.history(end); }
  /// Writes all cells, or adds those of a plan with so many samples.
  void state(Archive& archive, std::size_t samples);

 private:
  HistoryCollector history_;
};

}  // namespace poesy
