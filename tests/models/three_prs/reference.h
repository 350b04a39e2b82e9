#pragma once

#include <array>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "models/three_prs/errors.h"
#include "models/three_prs/kinematics.h"
#include "models/three_prs/model.h"

namespace poesy::three_prs {

inline constexpr double kMm = 1e-3;

/// Reference values computed independently, in mm and rad. Lives as long as the program: tests loop over its parts.
inline const nlohmann::json& oracle() {
  static const nlohmann::json values = [] {
    std::ifstream file(std::string(POESY_TEST_DATA) + "/kinematics_3prs.json");
    return nlohmann::json::parse(file);
  }();
  return values;
}

inline std::unique_ptr<Model> published(std::string_view fidelity) {
  const CatalogEntry entry = catalog_entry();
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return entry.build(geometry, fidelity == "exact" ? 0 : 1);
}

/// The outcome of one sample. Responses and details are in the order of the model.
struct Solved {
  std::array<double, 12> responses{};
  std::array<double, 3> swing{};
  SolveStatus status{};
  std::uint32_t iterations = 0;
};

inline Solved solve(const Model& model, std::span<const double> pose, std::span<const double> errors) {
  Solved out;
  model.evaluator({})->evaluate({pose, errors, {}, {}, 1},
                                {out.responses, std::span(&out.status, 1), std::span(&out.iterations, 1), out.swing});
  return out;
}

/// Random poses in the default workspace.
inline std::vector<std::vector<double>> random_poses(std::size_t count, unsigned seed) {
  const ModelDescription description = catalog_entry().description;
  std::mt19937_64 engine(seed);
  std::vector<std::vector<double>> poses(count);
  for (std::vector<double>& pose : poses) {
    for (std::size_t k = 0; k < 3; ++k) {
      pose.push_back(
          std::uniform_real_distribution<double>(description.pose_lower[k], description.pose_upper[k])(engine));
    }
  }
  return poses;
}

}  // namespace poesy::three_prs
