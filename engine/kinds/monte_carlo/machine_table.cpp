#include "engine/kinds/monte_carlo/machine_table.h"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/base/contract.h"
#include "engine/run/effect_poses.h"

namespace poesy {
MachineTable::MachineTable(const Plan& plan, std::size_t responses, const Analysis& analysis)
    : plan_(&plan),
      responses_(responses),
      has_limits_(!analysis.limits.empty()),
      limits_(responses_, std::numeric_limits<double>::infinity()) {
  POESY_EXPECTS(plan.draws() == Draws::per_machine);
  for (const ResponseLimit& limit : analysis.limits) limits_[limit.response] = limit.most;
  for (std::size_t p = 0; p < plan.factors().size(); ++p) {
    // The score of an error by itself is not that of one whose others go with it, or whose mean is shifted: then there
    // is none.
    const Distribution& distribution = plan.distributions()[p];
    const bool has_score = !plan.is_correlated(p) && distribution.shift() == 0.0;
    scales_.push_back({has_score ? distribution.sigma() : 0.0, distribution.half_width()});
  }
  effect_poses_ = poesy::effect_poses(plan.poses().size(), responses_, scales_.size());
}

std::size_t MachineTable::unit_machines(std::size_t poses) {
  // Rows of 500 numbers would lie nearly a page apart, which costs a third of the solver's speed.
  constexpr std::array<std::size_t, 4> kSizes{1000, 200, 100, 40};
  static_assert(std::ranges::all_of(kSizes, [](std::size_t size) { return Plan::kUnitSamples % size == 0; }));
  constexpr std::size_t kMostSamples = 100'000;
  const auto* const size = std::ranges::find_if(kSizes, [&](std::size_t one) { return one * poses <= kMostSamples; });
  return size == kSizes.end() ? kSizes.back() : *size;
}

std::size_t MachineTable::units_for(std::size_t machines, std::size_t poses) {
  const std::size_t each = unit_machines(poses);
  return (machines + each - 1) / each;
}

WorkUnit MachineTable::unit(std::size_t n) const {
  POESY_EXPECTS(n < units());
  const std::size_t each = unit_machines(plan_->poses().size());
  return {0, PoseIndex(0), SampleIndex(n * each), std::min(each, plan_->samples() - n * each)};
}

}  // namespace poesy
