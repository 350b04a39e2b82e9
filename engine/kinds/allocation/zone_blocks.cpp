#include "engine/kinds/allocation/zone_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "engine/base/name_pattern.h"
#include "engine/base/text.h"
#include "engine/drawing/zone_scatter.h"
#include "engine/kinds/allocation/zone_parts.h"

namespace poesy::allocation {
namespace {

/// A zone of a feature: the feature's index in ModelDescription::features, and the key of the zone.
struct ZoneAt {
  std::size_t feature;
  std::string_view key;
};

/// All zones of a drawing, feature by feature, the location before the orientation.
std::vector<ZoneAt> all_zones(const ModelDescription& model) {
  std::vector<ZoneAt> zones;
  for (std::size_t f = 0; f < model.features.size(); ++f) {
    for (const auto* zone : {&model.features[f].location, &model.features[f].orientation}) {
      if (*zone) zones.push_back({f, (*zone)->key});
    }
  }
  return zones;
}

/// The name of a zone with the number of its limb: "rail_1.position".
std::string name_at(const ZoneAt& zone, const ModelDescription& model) {
  return fmt::format("{}.{}", model.features[zone.feature].name, zone.key);
}

/// The name of a zone for all limbs that have it: "rail.position".
std::string label_at(const ZoneAt& zone, const ModelDescription& model) {
  return fmt::format("{}.{}", model.features[zone.feature].label, zone.key);
}

/// The zones whose names fit one of these patterns, in the order of the drawing.
std::vector<ZoneAt> zones_by_pattern(const StudyValue& value, const ModelDescription& model) {
  const std::vector<ZoneAt> all = all_zones(model);
  std::vector<bool> is_named(all.size(), false);
  for (const StudyValue& element : value.list()) {
    const std::string pattern = element.text();
    bool any = false;
    for (std::size_t z = 0; z < all.size(); ++z) {
      if (!matches(pattern, label_at(all[z], model)) && !matches(pattern, name_at(all[z], model))) continue;
      is_named[z] = any = true;
    }
    if (any) continue;
    std::vector<std::string> known;
    for (const ZoneAt& zone : all) {
      if (std::ranges::find(known, label_at(zone, model)) == known.end()) known.push_back(label_at(zone, model));
    }
    element.fail("is '" + printable(pattern) + "', which is not a zone of the drawing",
                 suggestion(pattern, std::vector<std::string_view>(known.begin(), known.end())));
  }
  std::vector<ZoneAt> zones;
  for (std::size_t z = 0; z < all.size(); ++z) {
    if (is_named[z]) zones.push_back(all[z]);
  }
  if (zones.empty()) value.fail("is empty", "name zones, e.g. [\"" + label_at(all.front(), model) + "\"]");
  return zones;
}

/// Refuses a block whose zones cannot be parts.
void check_block(const StudySection& block, const StudyValue& zones, const Study& study) {
  if (const auto factors = block.find("factors")) {
    factors->fail("is set, and so is " + zones.full_name(), "write one of them, and the other in a block of its own");
  }
  if (study.model().features.empty() || all_zones(study.model()).empty()) {
    zones.fail("has no meaning for " + study.model().name + ", whose file has no features with zones",
               "write factors, or features = [...] with zones in its limbs");
  }
  if (!study.errors.zones) {
    zones.fail("is set, but [errors] does not say how much of a zone is used",
               "write errors.zones = { distribution = \"normal\", sigmas = 3 }");
  }
  if (!study.errors.zones->is_normal()) {
    zones.fail(
        "is set, but errors.zones has no normals, which alone grow with a tolerance as an allocation needs",
        "write errors.zones = { distribution = \"normal\", sigmas = 3 }, and try the drawing that it finds with the "
        "other distribution");
  }
  if (!is_each(block)) {
    zones.fail("is set, but each is not true, and a zone is a tolerance of its own", "write each = true");
  }
  if (const auto name = block.find("name")) {
    name->fail("is set, but every zone has its name on the drawing", "remove it");
  }
  for (const std::string_view key : {"sigmas", "cpk"}) {
    if (const auto own = block.find(key)) {
      own->fail("is set, but errors.zones says how much of a zone is used", "remove it, or change errors.zones");
    }
  }
}

/// The errors of the part that a zone forms.
PartMembers errors_of(const ZoneAt& zone, const ModelDescription& model) {
  const Feature& feature = model.features[zone.feature];
  if (zone_class(zone.key, feature.kind) == ZoneClass::orientation) return feature.tilt;
  return feature.orientation ? feature.middle : feature.errors();
}

void check_errors(const StudyValue& value, const ZoneAt& zone, const Study& study) {
  const ModelDescription& model = study.model();
  const PartMembers errors = errors_of(zone, model);
  for (const FactorIndex error : errors) {
    if (std::ranges::find(study.analysis.factors, error) != study.analysis.factors.end()) continue;
    value.fail(fmt::format("has '{}' with the error '{}', which the study does not vary", name_at(zone, model),
                           model.factors[error.value].name),
               "name it in analysis.factors, or leave the zone out");
  }
  check_distributions(value, errors, study);
}

/// Refuses keys that only distances may have, if the block has a zone that is not a distance.
void check_distances(const StudySection& block, const std::vector<ZoneAt>& zones, const ModelDescription& model) {
  for (const std::string_view key : {"shift", "grades", "nominal_size"}) {
    const auto value = block.find(key);
    if (!value) continue;
    for (const ZoneAt& zone : zones) {
      if (model.features[zone.feature].kind == FeatureKind::distance) continue;
      value->fail(fmt::format("is set, but '{}' is not a distance", label_at(zone, model)),
                  "write the distances in a block of their own");
    }
  }
}

/// Whether two zones would share a tolerance if their limbs were identical. False for zones of one limb.
bool are_alike(const ZoneAt& a, const ZoneAt& b, const ModelDescription& model) {
  const Feature& one = model.features[a.feature];
  const Feature& other = model.features[b.feature];
  return a.key == b.key && one.label == other.label && one.kind == other.kind && one.limb != other.limb &&
         one.one_direction == other.one_direction && one.orientation.has_value() == other.orientation.has_value();
}

/// Joins zones of identical limbs into parts.
std::vector<std::vector<ZoneAt>> joined(const std::vector<ZoneAt>& zones, const Limbs& limbs,
                                        const ModelDescription& model) {
  const auto is_listed = [&](const ZoneAt& zone) {
    return std::ranges::find(limbs, model.features[zone.feature].limb) != limbs.end();
  };
  std::vector<std::vector<ZoneAt>> parts;
  for (const ZoneAt& zone : zones) {
    const auto fits = [&](const std::vector<ZoneAt>& part) {
      return is_listed(zone) && is_listed(part.front()) && are_alike(zone, part.front(), model);
    };
    const auto at = std::ranges::find_if(parts, fits);
    if (at == parts.end()) {
      parts.push_back({zone});
    } else {
      at->push_back(zone);
    }
  }
  return parts;
}

/// The name of a part: "rail.position" if it has the zones of all features with this label, otherwise
/// "rail_1.position".
std::string name_of(const std::vector<ZoneAt>& zones, const ModelDescription& model) {
  const Feature& first = model.features[zones.front().feature];
  const auto all = static_cast<std::size_t>(std::ranges::count(model.features, first.label, &Feature::label));
  return zones.size() == all ? label_at(zones.front(), model) : name_at(zones.front(), model);
}

AllocatedPart part_of(const std::vector<ZoneAt>& zones, const Study& study) {
  const ModelDescription& model = study.model();
  AllocatedPart part;
  part.name = name_of(zones, model);
  part.zone = PartZone{std::string(zones.front().key), {}};
  for (const ZoneAt& zone : zones) {
    part.zone->features.push_back(zone.feature);
    const PartMembers errors = errors_of(zone, model);
    part.factors.insert(part.factors.end(), errors.begin(), errors.end());
  }
  part.sigmas = drawing::sigmas_of(model.features[zones.front().feature], *study.errors.zones);
  return part;
}

/// Returns true if a part is in some pair of zones: as the zone of orientation if side = &Within::inner, as the zone of
/// location if side = &Within::outer.
bool has_pair(std::span<const Within> pairs, std::size_t part, std::size_t Within::*side) {
  return std::ranges::any_of(pairs, [&](const Within& pair) { return pair.*side == part; });
}

}  // namespace

std::vector<AllocatedPart> read_zones(const StudySection& block, const Study& study,
                                      std::span<const std::string_view> taken) {
  const ModelDescription& model = study.model();
  const StudyValue value = block.require("zones");
  check_block(block, value, study);
  if (value.is_text() && value.text() != "all") {
    value.fail("is '" + printable(value.text()) + "'",
               "write \"all\", or a list such as [\"" + label_at(all_zones(model).front(), model) + "\"]");
  }
  const std::vector<ZoneAt> zones = value.is_text() ? all_zones(model) : zones_by_pattern(value, model);
  for (const ZoneAt& zone : zones) check_errors(value, zone, study);
  check_distances(block, zones, model);
  const auto identical = block.find("identical_limbs");
  const auto joins = joined(zones, identical ? read_limbs(*identical, model) : Limbs(), model);
  if (identical && joins.size() == zones.size()) {
    identical->fail("joins no two zones of this block", "name limbs that have the same features, or leave it out");
  }
  std::vector<AllocatedPart> parts;
  for (const auto& zones_of_part : joins) {
    parts.push_back(part_of(zones_of_part, study));
    if (std::ranges::find(taken, parts.back().name) == taken.end()) continue;
    value.fail("has '" + parts.back().name + "', which another block has as well",
               "a zone has one tolerance; leave it out of one of them");
  }
  return parts;
}

void complete_zones(const StudyValue& value, const Study& study, std::vector<AllocatedPart>& parts) {
  const ModelDescription& model = study.model();
  const std::size_t stated = parts.size();
  for (std::size_t i = 0; i < stated; ++i) {
    if (!parts[i].zone || is_orientation(parts[i], model) || !feature_of(parts[i], model).orientation) continue;
    if (has_pair(zone_pairs(parts, model), i, &Within::outer)) continue;
    std::vector<ZoneAt> zones;
    for (const std::size_t f : parts[i].zone->features) zones.push_back({f, model.features[f].orientation->key});
    for (const ZoneAt& zone : zones) check_errors(value, zone, study);
    AllocatedPart given = part_of(zones, study);
    given.choice = AllocatedPart::Choice::fixed;
    given.lo = model.features[zones.front().feature].orientation->size;
    for (const ZoneAt& zone : zones) given.lo = std::min(given.lo, model.features[zone.feature].orientation->size);
    parts.push_back(std::move(given));
  }
  const std::vector<Within> pairs = zone_pairs(parts, model);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i].zone || !is_orientation(parts[i], model)) continue;
    const Feature& feature = feature_of(parts[i], model);
    if (!feature.location || has_pair(pairs, i, &Within::inner)) continue;
    value.fail(fmt::format("has '{}' without the {} of the same features, on which it depends", parts[i].name,
                           feature.location->key),
               fmt::format("add \"{}.{}\" with the same identical_limbs, or leave it out", feature.label,
                           feature.location->key));
  }
}

std::string zones_text(const AllocatedPart& part, const ModelDescription& model) {
  std::vector<std::string> names;
  std::vector<std::string> limbs;
  for (const std::size_t f : part.zone->features) {
    names.push_back(in_quotes(name_at({f, part.zone->key}, model)));
    limbs.push_back(std::to_string(model.features[f].limb));
  }
  const std::string alike =
      limbs.size() > 1 ? fmt::format("identical_limbs = [{}]\n", fmt::join(limbs, ", ")) : std::string();
  const std::string shift = part.shift > 0.0 ? "shift = " + shortest(part.shift) + "\n" : "";
  return fmt::format("zones = [{}]\neach = true\n{}{}", fmt::join(names, ", "), alike, shift);
}

}  // namespace poesy::allocation
