#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "engine/model/model.h"

namespace poesy {

/// A mechanism that a study may name.
struct CatalogEntry {
  ModelDescription description;  ///< with the published geometry
  /// Builds the mechanism from the values of description.geometry, in that order (SI), and the position of a fidelity
  /// among description.fidelities, 0 where there is no choice.
  /// Throws std::invalid_argument with a clause that names the parameter and the rule it breaks.
  std::function<std::unique_ptr<Model>(std::span<const double> geometry, std::size_t fidelity)> build;
  /// The same mechanism by the metric of its platform, with responses of its own; null where no angle is weighed
  /// against a length, and in the entry by the metric itself.
  std::shared_ptr<const CatalogEntry> by_platform = nullptr;
  /// Where the description's metric is "platform": builds it with other points of the platform, at least three (its
  /// frame, m). Throws std::invalid_argument as build does.
  std::function<std::unique_ptr<Model>(std::span<const double> geometry, std::size_t fidelity,
                                       std::span<const PlatformPoint> points)>
      build_with_points = nullptr;
};

/// Mechanisms by name, in the order in which they are listed.
using Catalog = std::vector<CatalogEntry>;

/// The entry of that name, in capitals or small letters, or nullptr.
const CatalogEntry* find(const Catalog& catalog, std::string_view model_name);

}  // namespace poesy
