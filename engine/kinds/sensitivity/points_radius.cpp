#include "engine/kinds/sensitivity/points_radius.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/base/nan.h"
#include "engine/run/evaluate_unit.h"
#include "engine/stats/indices.h"
#include "engine/stats/rank_correlation.h"

namespace poesy::sensitivity {
namespace {

/// The points, each moved to `multiple` times its distance from the middle of all points.
std::vector<PlatformPoint> at_radius(std::vector<PlatformPoint> points, double multiple) {
  PlatformPoint middle{};
  for (const PlatformPoint& point : points) {
    for (std::size_t k = 0; k < middle.size(); ++k) middle[k] += point[k] / static_cast<double>(points.size());
  }
  for (PlatformPoint& point : points) {
    for (std::size_t k = 0; k < middle.size(); ++k) point[k] = middle[k] + multiple * (point[k] - middle[k]);
  }
  return points;
}

/// The mechanism at the fidelity "first-order"; none if it does not have this fidelity.
std::optional<MechanismChoice> to_first_order(MechanismChoice mechanism) {
  const std::vector<std::string>& fidelities = mechanism.entry->description.fidelities;
  const auto found = std::ranges::find(fidelities, "first-order");
  if (found == fidelities.end()) return std::nullopt;
  mechanism.fidelity = static_cast<std::size_t>(found - fidelities.begin());
  mechanism.compared.reset();
  return mechanism;
}

/// The model of the mechanism if the platform's metric uses these points; null if the mechanism refuses them.
std::unique_ptr<Model> model_with(MechanismChoice mechanism, std::vector<PlatformPoint> points) {
  mechanism.points = std::move(points);
  try {
    return build_model(mechanism);
  } catch (const InputError&) {
    return nullptr;
  }
}

/// [responses x errors] The effects (index x sigma, SI), by the published estimator. A pose at which the solve for an
/// error does not converge is left out for this error.
Result::Indices effects_of(const Plan& plan, const Model& model) {
  const std::vector<double> no_background(model.description().factors.size(), 0.0);
  std::vector<double> responses(model.description().responses.size());
  Array<std::vector<LocalIndex>, axis::Response, axis::Factor> local(
      {responses.size(), plan.slots()});  // local indices at each pose
  const auto evaluator = model.evaluator(plan.solver());
  for (std::size_t n = 0; n < some_poses(plan.poses().size()); ++n) {
    const std::span<const double> pose = plan.poses()[some_pose(n, plan.poses().size())];
    for (std::size_t slot = 0; slot < plan.slots(); ++slot) {
      const std::array error{plan.distributions()[slot].standard_deviation()};
      std::array status{SolveStatus::converged};
      std::array iterations{std::uint32_t{0}};
      evaluator->evaluate({pose, no_background, plan.factors().subspan(slot, 1), error, 1},
                          {responses, status, iterations, {}});
      if (status[0] != SolveStatus::converged) continue;
      for (std::size_t r = 0; r < responses.size(); ++r) {
        local(r, slot).push_back({responses[r] / error[0], 0.0});
      }
    }
  }
  Result::Indices effects(local.lengths());
  for (std::size_t r = 0; r < responses.size(); ++r) {
    for (std::size_t slot = 0; slot < plan.slots(); ++slot) {
      const double sigma = plan.distributions()[slot].standard_deviation();
      const double rounding = index_rounding(model.rounding(r), sigma);
      effects(r, slot) = sigma * told_from_rounding(published_index(local(r, slot)), rounding);
    }
  }
  return effects;
}

}  // namespace

Array<double, axis::RadiusMultiple, axis::Response> radius_rank_correlations(const Study& study, const Plan& plan) {
  POESY_EXPECTS(plan.slots() == plan.factors().size());
  const std::optional<MechanismChoice> mechanism = to_first_order(study.mechanism);
  if (!mechanism || !mechanism->entry->build_with_points) return {};
  const std::unique_ptr<Model> own = build_model(*mechanism);
  const Result::Indices effects = effects_of(plan, *own);
  const std::size_t responses = own->description().responses.size();
  Array<double, axis::RadiusMultiple, axis::Response> correlations({kPointsRadii.size(), responses}, kNaN);
  for (std::size_t k = 0; k < kPointsRadii.size(); ++k) {
    const std::unique_ptr<Model> other = model_with(*mechanism, at_radius(own->metric_points(), kPointsRadii[k]));
    if (!other) continue;
    const Result::Indices others = effects_of(plan, *other);
    for (std::size_t r = 0; r < responses; ++r) correlations(k, r) = kendall_tau(effects.row(r), others.row(r));
  }
  return correlations;
}

}  // namespace poesy::sensitivity
