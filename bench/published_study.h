#pragma once

#include "engine/study/study.h"
#include "models/registry.h"

namespace poesy::bench {

/// The study of Du et al. 2022, Section 6.2, with a number of poses and samples to choose.
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
  study.analysis.factors = model.find_set("deforming")->factors;
  study.analysis.samples = samples;
  study.analysis.background = Background{model.find_set("benign")->factors, 1e-3, degree};
  return study;
}

}  // namespace poesy::bench
