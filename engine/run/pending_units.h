#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "engine/base/contract.h"
#include "engine/study/plan.h"

namespace poesy {

/// The units of a plan that are still to be solved, in the plan's order, when some of each cell's first units are done.
class PendingUnits {
 public:
  /// done(cell): how many. Precondition: at most units_per_cell(). Refers to the plan.
  template <class Done>
  PendingUnits(const Plan& plan, const Done& done) : plan_(&plan), ends_(plan.cells()) {
    std::size_t end = 0;
    for (std::size_t cell = 0; cell < ends_.size(); ++cell) {
      POESY_EXPECTS(done(cell) <= plan.units_per_cell());
      end += plan.units_per_cell() - done(cell);
      ends_[cell] = end;
    }
  }

  std::size_t size() const { return ends_.empty() ? 0 : ends_.back(); }

  WorkUnit operator[](std::size_t n) const {
    POESY_EXPECTS(n < size());
    const auto cell = static_cast<std::size_t>(std::ranges::upper_bound(ends_, n) - ends_.begin());
    return plan_->unit((cell + 1) * plan_->units_per_cell() - (ends_[cell] - n));
  }

 private:
  const Plan* plan_;
  std::vector<std::size_t> ends_;  ///< [cells] pending units up to and with each cell
};

}  // namespace poesy
