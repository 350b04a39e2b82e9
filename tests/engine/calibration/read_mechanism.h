#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "engine/calibration/fit.h"
#include "engine/model/model.h"
#include "models/registry.h"

namespace poesy::calibration {

/// The text of a mechanism file in this folder of the test data.
inline std::string mechanism_text(const std::string& name, const std::string& folder = "calibration") {
  std::ifstream file(std::filesystem::path(POESY_TEST_DATA) / folder / name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The model of a mechanism file with its published geometry. text: content of the file.
inline std::unique_ptr<Model> model_of(const std::string& text) {
  const CatalogEntry entry = registry().from_text(text, "mechanism.toml");
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return entry.build(geometry, 0);
}

/// [errors x fitted] The matrix F: column j has the entry 1 at each error that fitted[j] names, else 0.
inline Matrix columns_for(const Model& model, const std::vector<std::vector<std::string>>& fitted) {
  const ModelDescription& description = model.description();
  Matrix F =
      Matrix::Zero(static_cast<Eigen::Index>(description.factors.size()), static_cast<Eigen::Index>(fitted.size()));
  for (std::size_t j = 0; j < fitted.size(); ++j) {
    for (const std::string& name : fitted[j]) {
      F(static_cast<Eigen::Index>(description.find_factor(name)->value), static_cast<Eigen::Index>(j)) = 1.0;
    }
  }
  return F;
}

/// Fitted directions F that all have the same scale (standard deviation in m or rad).
inline FittedDirections directions_for(const ExactMachine& machine, const Matrix& F, double scale) {
  return {F, Vector::Constant(F.cols(), scale), difference_steps(machine, F)};
}

}  // namespace poesy::calibration
