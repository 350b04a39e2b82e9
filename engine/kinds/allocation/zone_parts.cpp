#include "engine/kinds/allocation/zone_parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/base/contract.h"
#include "engine/drawing/zone_scatter.h"

namespace poesy::allocation {
namespace {

double square(double x) { return x * x; }

std::vector<std::size_t> positions_of(std::span<const FactorIndex> errors, std::span<const FactorIndex> factors) {
  std::vector<std::size_t> positions;
  for (const FactorIndex error : errors) {
    const auto at = std::ranges::find(factors, error);
    POESY_EXPECTS(at != factors.end());
    positions.push_back(static_cast<std::size_t>(at - factors.begin()));
  }
  return positions;
}

/// The mean squares of the errors of a feature's middle and tilt if its zone of location has size 1, or, without a zone
/// of location, if its zone of orientation has size 1.
struct UnitSquares {
  double middle;
  double tilt;
};

UnitSquares unit_squares(Feature feature, double sigmas) {
  if (feature.location) feature.location->size = 1.0;
  if (feature.orientation) feature.orientation->size = feature.location ? 0.0 : 1.0;
  const drawing::FeatureSigmas found = drawing::feature_sigmas(feature, sigmas);
  return {square(found.middle.value_or(0.0)), square(found.tilt.value_or(0.0))};
}

}  // namespace

const Feature& feature_of(const AllocatedPart& part, const ModelDescription& model) {
  return model.features[part.zone->features.front()];
}

bool is_orientation(const AllocatedPart& part, const ModelDescription& model) {
  return zone_class(part.zone->key, feature_of(part, model).kind) == ZoneClass::orientation;
}

const Zone& zone_of(const AllocatedPart& part, const ModelDescription& model) {
  const Feature& feature = feature_of(part, model);
  return is_orientation(part, model) ? *feature.orientation : *feature.location;
}

std::string limbs_of(const AllocatedPart& part, const ModelDescription& model) {
  std::vector<std::size_t> limbs;
  for (const std::size_t f : part.zone->features) limbs.push_back(model.features[f].limb);
  std::ranges::sort(limbs);
  const bool is_range = limbs.size() > 1 && limbs.back() - limbs.front() + 1 == limbs.size();
  if (is_range) return fmt::format("{}-{}", limbs.front(), limbs.back());
  return fmt::format("{}", fmt::join(limbs, ", "));
}

std::string_view shape_of(const AllocatedPart& part, const ModelDescription& model) {
  const Feature& feature = feature_of(part, model);
  if (feature.kind == FeatureKind::distance) return "interval";
  if (feature.one_direction) return "planes";
  if (feature.kind == FeatureKind::axis) return "cylinder";
  return feature.kind == FeatureKind::point ? "sphere" : "planes";
}

DrawnPart drawn_zone(const AllocatedPart& part, const ModelDescription& model, std::span<const FactorIndex> factors) {
  std::vector<FactorIndex> middle;
  std::vector<FactorIndex> tilt;
  for (const std::size_t f : part.zone->features) {
    const Feature& feature = model.features[f];
    middle.insert(middle.end(), feature.middle.begin(), feature.middle.end());
    tilt.insert(tilt.end(), feature.tilt.begin(), feature.tilt.end());
  }
  const auto of_middle = positions_of(middle, factors);
  const auto of_tilt = positions_of(tilt, factors);
  Feature feature = feature_of(part, model);
  if (feature.kind == FeatureKind::distance) {
    return {{{of_middle, mean_square_per_tolerance({part.sigmas, part.shift})}}};
  }
  const UnitSquares location = unit_squares(feature, part.sigmas);
  if (is_orientation(part, model)) {
    const bool is_alone = !feature.location;
    feature.location.reset();
    DrawnPart drawn{{{of_tilt, unit_squares(feature, part.sigmas).tilt}}};
    if (!is_alone) drawn.groups.push_back({of_middle, -location.middle});
    return drawn;
  }
  DrawnPart drawn{{{of_middle, location.middle}}};
  if (!feature.orientation && !of_tilt.empty()) drawn.groups.push_back({of_tilt, location.tilt});
  return drawn;
}

std::vector<Within> zone_pairs(std::span<const AllocatedPart> parts, const ModelDescription& model) {
  std::vector<Within> pairs;
  for (std::size_t outer = 0; outer < parts.size(); ++outer) {
    if (!parts[outer].zone || is_orientation(parts[outer], model)) continue;
    for (std::size_t inner = 0; inner < parts.size(); ++inner) {
      const AllocatedPart& part = parts[inner];
      if (inner == outer || !part.zone || part.zone->features != parts[outer].zone->features) continue;
      const double widest = drawing::widest_orientation(feature_of(part, model).kind);
      const bool is_given = part.choice == AllocatedPart::Choice::fixed;
      pairs.push_back({inner, outer, square(widest), is_given ? LeftOut::where_it_is_void : LeftOut::by_choice});
    }
  }
  return pairs;
}

}  // namespace poesy::allocation
