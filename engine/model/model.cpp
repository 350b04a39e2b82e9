#include "engine/model/model.h"

#include <algorithm>

#include "engine/base/text.h"
#include "engine/model/catalog.h"

namespace poesy {

std::optional<FactorIndex> ModelDescription::find_factor(std::string_view factor_name) const {
  const auto found =
      std::find_if(factors.begin(), factors.end(), [&](const Factor& factor) { return factor.name == factor_name; });
  if (found == factors.end()) return std::nullopt;
  return FactorIndex(static_cast<std::size_t>(found - factors.begin()));
}

const FactorSet* ModelDescription::find_set(std::string_view set_name) const {
  const auto found =
      std::find_if(factor_sets.begin(), factor_sets.end(), [&](const FactorSet& set) { return set.name == set_name; });
  return found == factor_sets.end() ? nullptr : &*found;
}

std::optional<std::vector<double>> Model::pose_from_chart(std::size_t /*chart*/,
                                                          std::span<const double> /*coordinates*/) const {
  return std::nullopt;
}

std::optional<SolveTrace> Model::trace(std::span<const double> /*pose*/, std::span<const double> /*errors*/,
                                       const SolverOptions& /*options*/) const {
  return std::nullopt;
}

Separation Model::separation(std::span<const double> /*pose*/) const { return {}; }

double Model::rounding(std::size_t /*response*/) const { return 0.0; }

ErrorBound Model::error_bound(FactorIndex /*factor*/) const { return {}; }

std::vector<PlatformPoint> Model::metric_points() const { return {}; }

std::vector<std::string> Model::mobility() const { return {}; }

std::optional<Sketch> Model::sketch() const { return std::nullopt; }

std::vector<std::string> Model::unusual_geometry() const { return {}; }

const CatalogEntry& by_metric(const CatalogEntry& entry, std::string_view metric) {
  return entry.description.metric != metric && entry.other_metric ? *entry.other_metric : entry;
}

const CatalogEntry* find(const Catalog& catalog, std::string_view model_name) {
  const std::string name = lower_case(model_name);
  const auto found = std::find_if(catalog.begin(), catalog.end(), [&](const CatalogEntry& entry) {
    return lower_case(entry.description.name) == name;
  });
  return found == catalog.end() ? nullptr : &*found;
}

}  // namespace poesy
