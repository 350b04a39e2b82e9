#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/contract.h"
#include "engine/run/shard.h"
#include "engine/study/plan.h"

namespace poesy {

/// The units of a plan that are still to be solved, in the plan's order: of each cell those between the first ones that
/// are done and as many as are wanted.
class PendingUnits {
 public:
  /// done(cell), wanted(cell): how many of the cell's units. Precondition: at most units_per_cell(). Refers to the
  /// plan.
  template <class Done, class Wanted>
  PendingUnits(const Plan& plan, const Done& done, const Wanted& wanted) : plan_(&plan) {
    std::size_t end = 0;
    for (std::size_t cell = 0; cell < plan.cells(); ++cell) {
      const std::size_t last = wanted(cell);
      POESY_EXPECTS(done(cell) <= plan.units_per_cell() && last <= plan.units_per_cell());
      if (last > done(cell)) {
        end += last - done(cell);
        samples_ += plan.first_sample(last) - plan.first_sample(done(cell));
      }
      ends_.push_back({end, last});
    }
  }

  /// All units of the shard's cells are wanted.
  template <class Done>
  PendingUnits(const Plan& plan, const Shard& shard, const Done& done)
      : PendingUnits(plan, done, [&plan, cells = shard.of(plan.cells())](std::size_t cell) {
          return cells.holds(cell) ? plan.units_per_cell() : 0;
        }) {}

  /// Units that are still to be solved.
  std::size_t size() const { return ends_.empty() ? 0 : ends_.back().pending; }

  /// In all of them.
  std::uint64_t samples() const { return samples_; }

  /// The n-th of them, in the order of the plan.
  WorkUnit operator[](std::size_t n) const {
    POESY_EXPECTS(n < size());
    const auto end = std::ranges::upper_bound(ends_, n, {}, &End::pending);
    const auto cell = static_cast<std::size_t>(end - ends_.begin());
    return plan_->unit(cell * plan_->units_per_cell() + end->unit - (end->pending - n));
  }

 private:
  /// Where a cell's pending units end: how many there are up to and with this cell, and the unit within the cell.
  struct End {
    std::size_t pending;
    std::size_t unit;
  };

  const Plan* plan_;
  std::vector<End> ends_;  ///< [cells]
  std::uint64_t samples_ = 0;
};

}  // namespace poesy
