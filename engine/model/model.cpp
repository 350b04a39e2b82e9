#include "engine/model/model.h"

#include <algorithm>

#include "engine/base/text.h"

namespace poesy {

std::optional<FactorIndex> ModelDescription::find_factor(std::string_view factor_name) const {
  const auto found = std::ranges::find(factors, factor_name, &Factor::name);
  if (found == factors.end()) return std::nullopt;
  return FactorIndex(static_cast<std::size_t>(found - factors.begin()));
}

const FactorSet* ModelDescription::find_set(std::string_view set_name) const {
  const auto found = std::ranges::find(factor_sets, set_name, &FactorSet::name);
  return found == factor_sets.end() ? nullptr : &*found;
}

const CatalogEntry& by_metric(const CatalogEntry& entry, std::string_view metric) {
  const CatalogEntry* found = &entry;
  while (found->description.metric != metric && found->other_metric) found = found->other_metric.get();
  const std::string& reached = found->description.metric;
  return reached == metric || reached.empty() ? *found : entry;
}

const CatalogEntry* find(const Catalog& catalog, std::string_view model_name) {
  const auto found = std::ranges::find(catalog, lower_case(model_name),
                                       [](const CatalogEntry& entry) { return lower_case(entry.description.name); });
  return found == catalog.end() ? nullptr : &*found;
}

}  // namespace poesy
