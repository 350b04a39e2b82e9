#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
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
  /// The same mechanism by the other metric, with responses of its own; null where no angle is weighed against a
  /// length, and in that entry itself.
  std::shared_ptr<const CatalogEntry> other_metric = nullptr;
  /// Where the description's metric is "platform": builds it with other points of the platform, at least three (its
  /// frame, m). Throws std::invalid_argument as build does.
  std::function<std::unique_ptr<Model>(std::span<const double> geometry, std::size_t fidelity,
                                       std::span<const PlatformPoint> points)>
      build_with_points = nullptr;
  std::string file = {};  ///< path of the file that describes it; empty for those of the catalog
};

/// The entry or its other_metric, whichever weighs by this metric; the entry where nothing is weighed.
const CatalogEntry& by_metric(const CatalogEntry& entry, std::string_view metric);

/// Mechanisms by name, in the order in which they are listed, and the way to those that somebody describes in a file.
struct Catalog : std::vector<CatalogEntry> {
  using vector::vector;
  /// The mechanism of a file's text; `path` is for messages. Null: there are none from files.
  /// Throws InputError "FILE:LINE:COL: ..." where the text describes no mechanism.
  CatalogEntry (*from_text)(const std::string& text, const std::string& path) = nullptr;
  /// The reference of such files, as Markdown.
  std::string (*file_reference)() = nullptr;
};

/// The entry of that name, in capitals or small letters, or nullptr.
const CatalogEntry* find(const Catalog& catalog, std::string_view model_name);

}  // namespace poesy
