#include <algorithm>
#include <optional>
#include <utility>

#include "engine/kinds/what_if/what_if.h"
#include "engine/study/plan.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

/// The size of an error in display units: the parameter by which the study states its distribution, or the standard
/// deviation.
WhatIfSize size_of(const Distribution& error, Dimension dimension) {
  const Unit& unit = display_unit(dimension);
  using enum Distribution::Shape;
  switch (error.shape()) {
    case normal:
    case truncated_normal:
      return {"sigma", error.sigma() / unit.si, std::string(unit.name)};
    case uniform:
    case triangular:
      return {"\u00b1", error.half_width() / unit.si, std::string(unit.name)};
    case measured:
    case given:
      break;
  }
  return {"standard deviation", error.standard_deviation() / unit.si, std::string(unit.name)};
}

/// The sizes of the tolerance zones of a feature, mm.
std::vector<WhatIfSize> sizes_of(const Feature& feature) {
  std::vector<WhatIfSize> sizes;
  for (const auto& zone : {feature.location, feature.orientation}) {
    if (zone) sizes.push_back({std::string(zone->key), zone->size / display_unit(Dimension::length).si, "mm"});
  }
  return sizes;
}

/// Adds to `list` the errors of features that scatter in their tolerance zones. Leaves out errors to which the study
/// gives another distribution, and errors that machines draw anew at each pose. Features of the same name in several
/// limbs are joined. Returns whether each error of the plan was added.
std::vector<bool> add_features(const Study& study, const Plan& plan, std::vector<SizedErrors>& list) {
  const std::vector<std::optional<Distribution>> by_zones = distributions_by_zones(study);
  std::vector<bool> taken(plan.factors().size(), false);
  for (const Feature& feature : study.model().features) {
    std::vector<std::size_t> slots;
    for (const FactorIndex error : feature.errors()) {
      const auto at = std::ranges::find(plan.factors(), error);
      const auto slot = static_cast<std::size_t>(at - plan.factors().begin());
      const bool is_own = at != plan.factors().end() && by_zones[error.value] == study.errors.by_factor[error.value];
      if (is_own && !plan.is_per_pose(slot)) slots.push_back(slot);
    }
    std::vector<WhatIfSize> sizes = sizes_of(feature);
    if (slots.empty() || sizes.empty()) continue;
    auto same = std::ranges::find(list, feature.label, &SizedErrors::name);
    if (same == list.end()) same = list.insert(list.end(), {feature.label, std::move(sizes), {}});
    same->slots.insert(same->slots.end(), slots.begin(), slots.end());
    for (const std::size_t slot : slots) taken[slot] = true;
  }
  return taken;
}

}  // namespace

std::vector<SizedErrors> sized_errors(const Study& study, const PoseSet& poses) {
  const Plan plan(study, poses);
  std::vector<SizedErrors> list;
  const std::vector<bool> taken = add_features(study, plan, list);
  for (std::size_t p = 0; p < plan.factors().size(); ++p) {
    const Distribution& error = plan.distributions()[p];
    if (taken[p] || plan.is_per_pose(p) || error.shape() == Distribution::Shape::given) continue;
    const Factor& factor = study.model().factors[plan.factors()[p].value];
    list.push_back({factor.name, {size_of(error, factor.dimension)}, {p}});
  }
  return list;
}

}  // namespace poesy
