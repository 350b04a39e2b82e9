#include "engine/kinds/monte_carlo/machine_table.h"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/base/contract.h"

namespace poesy {
namespace {

/// Of all sums of main effects of a unit, about.
constexpr std::size_t kMostEffectBytes = std::size_t{2} << 20U;

/// At how many poses main effects fit into that, beside those of machines.
std::size_t count_effect_poses(std::size_t poses, std::size_t responses, std::size_t errors) {
  const std::size_t bytes = 2 * sizeof(double) * kEffectBins * std::max<std::size_t>(1, responses * errors);
  const std::size_t fit = kMostEffectBytes / bytes;
  return std::min({poses, MachineTable::kMostEffectPoses, std::max<std::size_t>(fit, 3) - 2});
}

}  // namespace

MachineTable::MachineTable(const Plan& plan, std::size_t responses, const Analysis& analysis)
    : plan_(&plan),
      responses_(responses),
      has_limits_(!analysis.limits.empty()),
      limits_(responses_, std::numeric_limits<double>::infinity()) {
  POESY_EXPECTS(plan.draws() == Draws::per_machine);
  for (const ResponseLimit& limit : analysis.limits) limits_[limit.response] = limit.most;
  std::vector<double> grid = bin_spread_grid();
  for (std::size_t p = 0; p < plan.factors().size(); ++p) {
    const Distribution& distribution = plan.distributions()[p];
    // The score of an error by itself is not that of one whose others go with it: then there is none.
    scales_.push_back({plan.is_correlated(p) ? 0.0 : distribution.sigma(), distribution.half_width()});
    std::vector<double> quantiles = grid;
    distribution.transform(quantiles);
    spreads_.push_back(bin_spread(quantiles));
  }
  const std::size_t poses = plan.poses().size();
  const std::size_t count = count_effect_poses(poses, responses_, plan.factors().size());
  for (std::size_t n = 0; n < count; ++n) effect_poses_.emplace_back(n * poses / count);
}

std::size_t MachineTable::unit_machines(std::size_t poses) {
  constexpr std::array<std::size_t, 5> kSizes{1000, 500, 250, 125, 50};
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
