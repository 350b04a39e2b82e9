#include "engine/run/verdict.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/run/counts.h"

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

/// One row of an evaluation at all its poses.
struct RowOutcome {
  double largest = kNaN;  ///< magnitude, over the poses that count
  std::size_t pose = 0;   ///< where it is
  bool complete = true;   ///< whether every pose counts
};

class Rows {
 public:
  Rows(const EvaluationResult& found, Pairing pairing, NotConverged policy)
      : found_(found), row_by_row_(pairing == Pairing::row_by_row), policy_(policy) {}

  std::size_t size() const { return row_by_row_ ? found_.poses : found_.samples; }

  RowOutcome operator()(std::size_t response, std::size_t row) const {
    RowOutcome outcome;
    const std::size_t first = row_by_row_ ? row : 0;
    const std::size_t end = row_by_row_ ? row + 1 : found_.poses;
    for (std::size_t m = first; m < end; ++m) {
      const std::size_t at = row_by_row_ ? m : m * found_.samples + row;
      if (!counts(found_.status[at], policy_)) {
        outcome.complete = false;
        continue;
      }
      const double magnitude = std::abs(found_.response[response * found_.status.size() + at]);
      if (magnitude <= outcome.largest) continue;
      outcome.largest = magnitude;
      outcome.pose = m;
    }
    return outcome;
  }

 private:
  const EvaluationResult& found_;
  bool row_by_row_;
  NotConverged policy_;
};

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

LimitVerdicts judge_rows(std::span<const ResponseLimit> limits, const EvaluationResult& found, Pairing pairing,
                         NotConverged policy) {
  LimitVerdicts verdicts;
  const Rows rows(found, pairing, policy);
  for (const ResponseLimit& limit : limits) {
    LimitVerdict verdict{.response = limit.response, .limit = limit.most, .value = kNaN, .tried = rows.size()};
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const RowOutcome outcome = rows(limit.response, row);
      if (outcome.complete && outcome.largest <= limit.most) ++verdict.within;
      if (std::isnan(outcome.largest) || outcome.largest <= verdict.value) continue;
      verdict.value = outcome.largest;
      verdict.pose = outcome.pose;
      verdict.row = row;
    }
    verdict.passed = verdict.within == verdict.tried;
    verdicts.limits.push_back(verdict);
  }
  return verdicts;
}

}  // namespace poesy
