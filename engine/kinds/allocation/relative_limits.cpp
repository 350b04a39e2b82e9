#include "engine/kinds/allocation/relative_limits.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"

namespace poesy::allocation {
namespace {

/// Solves the mechanism with all varied errors at their centres (zero, or a stated mean).
class PerfectSolver : private UnitSolver {
 public:
  PerfectSolver(const Plan& plan, const Model& model, const MachineCalibration* calibration)
      : UnitSolver(plan, model, plan.factors().size()) {
    for (std::size_t p = 0; p < plan.factors().size(); ++p) values_[p] = plan.distributions()[p].centre();
    if (calibration == nullptr) return;
    calibrated_ = calibration->evaluator(MachineCalibrator(*calibration).without_noise(all_errors(drawn(1))));
    solve_by(calibrated_.get());
  }
  /// [responses] The responses at a pose, SI. All are 0 if the mechanism is not solved at this pose; machines are then
  /// not solved there either.
  std::vector<double> operator()(PoseIndex pose) {
    const UnitOutcomes outcomes = UnitSolver::solve(pose, plan_->factors(), 1, 0.0);
    if (!counts(outcomes.status.front(), plan_->not_converged())) return std::vector<double>(responses_, 0.0);
    return {outcomes.responses.begin(), outcomes.responses.end()};
  }

 private:
  std::unique_ptr<Evaluator> calibrated_;
};

}  // namespace

RelativeLimits::RelativeLimits(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                               const MachineCalibration* calibration)
    : limits_(limits.begin(), limits.end()), centre_({limits.size(), plan.poses().size()}, 0.0) {
  const auto is_from_zero = [](const ResponseLimit& limit) {
    return limit.allowed.is_magnitude() || limit.allowed.is_spread();
  };
  if (std::ranges::all_of(limits_, is_from_zero)) return;
  PerfectSolver solve(plan, model, calibration);
  for (std::size_t m = 0; m < plan.poses().size(); ++m) {
    const std::vector<double> responses = solve(PoseIndex(m));
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      if (!is_from_zero(limits_[k])) centre_(k, m) = responses[limits_[k].response];
    }
  }
}

bool RelativeLimits::any_spread() const {
  return std::ranges::any_of(limits_, [](const ResponseLimit& limit) { return limit.allowed.is_spread(); });
}

double RelativeLimits::room(std::size_t k, PoseIndex pose) const {
  const ValueLimit& limit = limits_[k].allowed;
  if (limit.is_spread()) return 0.5 * limit.to();
  if (limit.is_magnitude()) return limit.to();
  return std::min(limit.to() - centre(k, pose), centre(k, pose) - limit.from());
}

namespace {

/// Corrects a load for rounding, so that it is at most 1 if and only if the limit holds.
double rounded_load(double load, bool holds) {
  return holds ? std::min(load, 1.0) : std::max(load, std::nextafter(1.0, 2.0));
}

}  // namespace

double RelativeLimits::load(std::size_t k, PoseIndex pose, double value) const {
  const ValueLimit& limit = limits_[k].allowed;
  const double away = value - centre(k, pose);
  const double end = (away < 0.0 ? limit.from() : limit.to()) - centre(k, pose);
  return rounded_load(away / end, limit.holds(value));
}

double RelativeLimits::load_over_poses(std::size_t k, std::span<double> at_poses) const {
  const ValueLimit& limit = limits_[k].allowed;
  if (limit.is_spread()) {
    const double spread = limit.deciding(at_poses, at_poses.size());
    return rounded_load(spread / limit.to(), limit.holds(spread));
  }
  const auto place = at_poses.begin() + static_cast<std::ptrdiff_t>(limit.poses_beyond(at_poses.size()));
  std::ranges::nth_element(at_poses, place, std::ranges::greater());
  return *place;
}

}  // namespace poesy::allocation
