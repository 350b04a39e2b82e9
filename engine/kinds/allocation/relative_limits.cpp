#include "engine/kinds/allocation/relative_limits.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"

namespace poesy {
namespace {

/// Solves the mechanism whose errors that vary are at their centres.
class PerfectSolver : private UnitSolver {
 public:
  PerfectSolver(const Plan& plan, const Model& model) : UnitSolver(plan, model, plan.factors().size()) {
    for (std::size_t p = 0; p < plan.factors().size(); ++p) values_[p] = plan.distributions()[p].centre();
  }
  /// [R] The responses at a pose; zero if it is not solved, so that no machine will be.
  std::vector<double> operator()(PoseIndex pose) {
    const UnitOutcomes outcomes = UnitSolver::solve(pose, plan_->factors(), 1, 0.0);
    if (!counts(outcomes.status.front(), plan_->not_converged())) return std::vector<double>(responses_, 0.0);
    return {outcomes.responses.begin(), outcomes.responses.end()};
  }
};

}  // namespace

RelativeLimits::RelativeLimits(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits)
    : limits_(limits.begin(), limits.end()), centre_({limits.size(), plan.poses().size()}, 0.0) {
  POESY_EXPECTS(!any_over_poses(limits));
  const auto is_magnitude = [](const ResponseLimit& limit) { return limit.allowed.is_magnitude(); };
  if (std::ranges::all_of(limits_, is_magnitude)) return;
  PerfectSolver solve(plan, model);
  for (std::size_t m = 0; m < plan.poses().size(); ++m) {
    const std::vector<double> responses = solve(PoseIndex(m));
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      if (!is_magnitude(limits_[k])) centre_(k, m) = responses[limits_[k].response];
    }
  }
}

double RelativeLimits::room(std::size_t k, PoseIndex pose) const {
  const ValueLimit& limit = limits_[k].allowed;
  if (limit.is_magnitude()) return limit.to();
  return std::min(limit.to() - centre(k, pose), centre(k, pose) - limit.from());
}

double RelativeLimits::load(std::size_t k, PoseIndex pose, double value) const {
  const ValueLimit& limit = limits_[k].allowed;
  const double away = value - centre(k, pose);
  const double end = (away < 0.0 ? limit.from() : limit.to()) - centre(k, pose);
  const double load = away / end;
  return limit.holds(value) ? std::min(load, 1.0) : std::max(load, std::nextafter(1.0, 2.0));
}

}  // namespace poesy
