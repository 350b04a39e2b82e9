#pragma once

#include <algorithm>

#include "engine/kinds/sensitivity/result.h"
#include "engine/random/stream.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"
#include "models/registry.h"

namespace poesy::bench {

/// The study of Du et al. 2022, Section 6.2, with this number of poses, and this number of samples for each error and
/// pose.
inline Study published_study(std::size_t poses, std::size_t samples) {
  const CatalogEntry* entry = find(registry(), "2upr-rpu");
  const ModelDescription& model = entry->description;
  Study study;
  study.mechanism.entry = entry;
  for (const GeometryParameter& parameter : model.geometry) study.mechanism.geometry.push_back(parameter.published);
  study.poses.count = poses;
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    study.poses.workspace.push_back({model.pose_lower[c], model.pose_upper[c]});
  }
  const double degree = parse_quantity("1 deg").si;
  for (const Factor& factor : model.factors) {
    study.errors.by_factor.push_back(Distribution::normal(factor.dimension == Dimension::length ? 1e-3 : degree));
  }
  study.analysis.kind = &sensitivity::kStudy;
  study.analysis.factors = model.find_set("deforming")->factors;
  study.analysis.samples = samples;
  study.analysis.background = Background{model.find_set("benign")->factors, 1e-3, degree};
  return study;
}

/// The study of published_study(), but solved with the metric of the platform. fidelity: 0: exact; 1: to first order.
inline Study platform_study(std::size_t poses, std::size_t samples, std::size_t fidelity = 0) {
  Study study = published_study(poses, samples);
  study.mechanism.entry = study.mechanism.entry->other_metric.get();
  study.mechanism.fidelity = fidelity;
  study.solver.tolerance = study.model().tolerance;
  return study;
}

inline constexpr std::size_t kPublishedPoses = 158;
inline constexpr std::size_t kPublishedSamples = 1000;

/// The poses with the indices 0, step, 2 step, ... of a set.
inline PoseSet every(std::size_t step, const PoseSet& poses) {
  std::vector<double> values;
  for (std::size_t m = 0; m < poses.size(); m += step) {
    const auto pose = poses[PoseIndex(m)];
    values.insert(values.end(), pose.begin(), pose.end());
  }
  return {poses.coordinates(), std::move(values)};
}

/// The n-th unit on a walk through the plan with a stride of 1597 units. The stride has no common factor with the
/// number of units of the published study, so even a few units have many different factors and poses.
inline WorkUnit scattered_unit(const Plan& plan, std::size_t n) { return plan.unit(n * 1597 % plan.units()); }

/// [factors x count] Samples of all errors of the study's model at one pose (SI), row-major: the draws of the study,
/// multiplied by `scale`.
inline std::vector<double> samples_of_all_errors(const Study& study, double scale, PoseIndex pose, std::size_t count) {
  const std::vector<Distribution>& distributions = study.errors.by_factor;
  std::vector<double> values(distributions.size() * count);
  for (std::size_t f = 0; f < distributions.size(); ++f) {
    const std::span row = std::span(values).subspan(f * count, count);
    fill_uniforms({study.seed, Purpose::error_samples, FactorIndex(f), pose}, SampleIndex(0), row);
    distributions[f].transform(row);
    for (double& value : row) value *= scale;
  }
  return values;
}

}  // namespace poesy::bench
