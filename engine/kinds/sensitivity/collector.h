#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/kinds/sensitivity/index_history.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/evaluate_unit.h"
#include "engine/study/plan.h"

namespace poesy {

/// Puts the units of a sensitivity study together, cell by cell. What a cell becomes depends on the order of its own
/// units alone. A last unit with fewer than Plan::kUnitSamples samples is kept apart, for it is not the beginning of
/// any unit of a study with more samples; all others are.
class SensitivityCollector {
 public:
  /// Refers to the plan.
  SensitivityCollector(const Plan& plan, std::size_t responses, double conf_level);

  /// Precondition: the unit after those done in its cell.
  void add(const WorkUnit& unit, const CellUnit& found);

  /// Units of this cell that were added.
  std::size_t units_done(std::size_t cell) const;
  /// Over all that was added.
  SolveCounts total() const;
  /// One slot at all poses, [M], from what was added.
  std::vector<UnitStats> cells_of(std::size_t slot) const;
  /// From what was added.
  std::vector<UnitStats> cells() &&;
  /// Of the indices, whose last are those of `end`. Precondition: all units were added, those of all cells; the study
  /// has a fixed number of samples.
  EstimateCourse history(const SensitivityResult& end) const { return history_.history(end); }

  /// Everything added so far.
  Bytes state() const;
  /// Takes up a state of this plan, or of one that differs by fewer samples. States that hold different cells may stand
  /// one behind the other. Throws BytesError for anything else. Precondition: nothing was added.
  void restore(std::span<const std::byte> state);

 private:
  std::size_t cell_of(const WorkUnit& unit) const { return unit.slot * plan_->poses().size() + unit.pose.value; }
  bool has_part(std::size_t cell) const { return !parts_.empty() && parts_[cell].solves.total() > 0; }
  void restore_one(ByteReader& from);
  /// Gives the cell's units in that state.
  std::size_t restore_cell(ByteReader& from, std::size_t cell, std::size_t samples);

  const Plan* plan_;
  std::size_t responses_;
  std::vector<UnitStats> whole_;  ///< [cells] units of full size
  std::vector<UnitStats> parts_;  ///< [cells] the last unit where it is smaller; empty when the plan has none such
  HistoryCollector history_;
};

}  // namespace poesy
