#include "engine/kinds/monte_carlo/verdict.h"

#include <algorithm>
#include <cmath>

namespace poesy {
namespace {

/// Samples whose magnitude is within a limit; a bucket that the limit divides counts as its middle lies.
std::uint64_t count_within(const QuantileSketch& samples, double limit) {
  std::uint64_t within = 0;
  for (const Bucket& bucket : samples.buckets()) {
    const double middle = 0.5 * bucket.lower + 0.5 * bucket.upper;
    if (std::abs(middle) <= limit) within += bucket.count;
  }
  return within;
}

/// What the share of the draws stays within at the worst pose, into `value` and `pose`.
void take_worst_pose(const MonteCarloResult& found, LimitVerdict& verdict) {
  const std::span at_poses = std::span(found.share_magnitude).subspan(verdict.response * found.poses, found.poses);
  const auto worst = std::ranges::max_element(at_poses);
  verdict.value = *worst;
  verdict.pose = static_cast<std::size_t>(worst - at_poses.begin());
}

}  // namespace

LimitVerdicts judge_draws(std::span<const ResponseLimit> limits, Judge judge, double share,
                          const MonteCarloResult& found, std::span<const QuantileSketch> overall) {
  LimitVerdicts verdicts{.judge = judge, .share = share, .limits = {}};
  const std::uint64_t tried = found.total().total();
  for (const ResponseLimit& limit : limits) {
    LimitVerdict verdict{.response = limit.response, .limit = limit.most, .tried = tried};
    verdict.within = count_within(overall[limit.response], limit.most);
    if (judge == Judge::rms) {
      verdict.value = found.overall_rms[limit.response];
    } else {
      take_worst_pose(found, verdict);
    }
    verdict.passed = verdict.value <= limit.most;
    verdicts.limits.push_back(verdict);
  }
  return verdicts;
}

}  // namespace poesy
