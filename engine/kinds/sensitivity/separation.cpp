#include "engine/kinds/sensitivity/separation.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/stats/indices.h"

namespace poesy {
namespace {

/// 1 - residual / effect, at least zero; NaN where that is not finite.
double removable_part(double residual, double effect) {
  const double left = residual / effect;
  return std::isfinite(left) ? std::max(0.0, 1.0 - left) : kNaN;
}

/// Of one error: the same, and NaN where its effect is rounding.
double removable_share(double residual, double effect) {
  return has_effect(effect) ? removable_part(residual, effect) : kNaN;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// All poses' values of the separated errors, [P x M].
void fill_cells(const Model& model, const PoseSet& poses, std::span<const FactorIndex> factors,
                SeparationResult& result) {
  const std::size_t cells = factors.size() * poses.size();
  for (auto* values : {&result.drive, &result.constraint, &result.effect, &result.residual}) values->resize(cells);
  for (std::size_t m = 0; m < poses.size(); ++m) {
    const Separation at_pose = model.separation(poses[PoseIndex(m)]);
    for (std::size_t p = 0; p < factors.size(); ++p) {
      const std::size_t cell = p * poses.size() + m;
      result.drive[cell] = at_pose.drive[factors[p].value];
      result.constraint[cell] = at_pose.constraint[factors[p].value];
      result.effect[cell] = at_pose.effect[factors[p].value];
      result.residual[cell] = at_pose.residual[factors[p].value];
    }
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    result.removable_local.push_back(removable_share(result.residual[cell], result.effect[cell]));
  }
}

}  // namespace

SeparationResult separate_errors(const Model& model, const PoseSet& poses, std::span<const FactorIndex> factors,
                                 std::span<const double> sigma) {
  POESY_EXPECTS(sigma.size() == factors.size());
  SeparationResult result;
  fill_cells(model, poses, factors, result);
  double effects = 0.0;
  double residuals = 0.0;
  for (std::size_t p = 0; p < factors.size(); ++p) {
    const auto over_poses = [&](const std::vector<double>& values) {
      return root_mean_square(std::span(values).subspan(p * poses.size(), poses.size()));
    };
    const double effect = over_poses(result.effect);
    const double residual = over_poses(result.residual);
    const double drive = over_poses(result.drive);
    result.removable.push_back(removable_share(residual, effect));
    result.drive_share.push_back(std::isnan(result.removable.back()) ? kNaN
                                                                     : drive / (drive + over_poses(result.constraint)));
    effects = std::hypot(effects, sigma[p] * effect);
    residuals = std::hypot(residuals, sigma[p] * residual);
  }
  result.removable_together = removable_part(residuals, effects);
  return result;
}

}  // namespace poesy
