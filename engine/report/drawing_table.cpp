#include "engine/report/drawing_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/model/feature.h"
#include "engine/model/feature_errors.h"
#include "engine/report/display.h"
#include "engine/report/signs.h"
#include "engine/schema/settings.h"
#include "engine/stats/moments.h"

namespace poesy {
namespace {

/// A zone as text, with its size in mm: "position 0.05 A|B"; "-" if the feature has no such zone. key: type of the
/// zone. size: m. datums: "-" if there are none.
std::string zone_text(const std::string& key, double size, const std::string& datums) {
  if (key == "-") return key;
  const bool is_size = key == "tolerance";
  return fmt::format("{}{:.6g}{}", is_size ? "+-" : key + " ", 1e3 * size, datums == "-" ? "" : " " + datums);
}

/// Returns true if an error belongs to a feature. q: position of the feature in the result.
bool is_of_feature(const DrawingResult& drawing, std::size_t q, const std::string& error) {
  return std::ranges::any_of(kFeatureDirections, [&](std::string_view direction) {
    return error == feature_error_name(drawing.label(q), direction, drawing.limb(q));
  });
}

/// [features] The word for what sets the sizes of a feature's errors instead of its zones: "measured" if some of them
/// are measured, "overridden" if [errors.override] sets some of them, else empty.
std::vector<std::string_view> instead_of_zones(const StoredResult& result) {
  std::vector<std::string> overridden;
  for (StudySetting& one : study_settings(result.study_text)) {
    if (one.section == "errors.override") overridden.push_back(std::move(one.key));
  }
  std::vector<std::string_view> list;
  for (std::size_t q = 0; q < result.drawing->features(); ++q) {
    const auto is_of_it = [&](const std::string& error) { return is_of_feature(*result.drawing, q, error); };
    list.push_back(std::ranges::any_of(result.measured.names, is_of_it) ? "measured"
                   : std::ranges::any_of(overridden, is_of_it)          ? "overridden"
                                                                        : "");
  }
  return list;
}

/// Returns true if the zones of a feature lie between two planes, so that their size is a width and not a diameter.
/// This holds for the zones of a plane face, and for those of an axis or a point that has errors in only one of the
/// directions x and y. q: index of the feature in the result.
bool is_between_planes(const StoredResult& result, std::size_t q) {
  const DrawingResult& found = *result.drawing;
  const std::string& kind = found.kind(q);
  if (kind != "axis" && kind != "point") return kind != "distance";
  const auto has = [&](FeatureDirection direction) {
    const std::string name = feature_error_name(found.label(q), poesy::name(direction), found.limb(q));
    return std::ranges::find(result.factors, name, &NamedUnit::name) != result.factors.end();
  };
  using enum FeatureDirection;
  return (has(x) || has(lean_x)) != (has(y) || has(lean_y));
}

/// The cell of a zone. It has a tolerance frame (Cell::boxes), except for the tolerance of a distance, for a clearance,
/// and if `instead` is not empty. instead: the word from instead_of_zones() for the feature. q: index of the feature in
/// the result. size: m.
Cell zone_cell(const StoredResult& result, std::size_t q, std::string_view instead, const std::string& key, double size,
               const std::string& datums) {
  if (key != "-" && !instead.empty()) {
    return text_cell(fmt::format("{}, instead of {}", instead, zone_text(key, size, datums)));
  }
  Cell cell = text_cell(zone_text(key, size, datums));
  const auto known = std::ranges::find(zone_traits(), key, &ZoneTraits::key);
  if (known == zone_traits().end() || known->of == ZoneClass::size) return cell;
  const std::string_view before = is_between_planes(result, q)         ? std::string_view()
                                  : result.drawing->kind(q) == "point" ? kSphereDiameter
                                                                       : kDiameter;
  cell.boxes = frame_boxes(known->sign, fmt::format("{}{:.6g}", before, 1e3 * size), datums == "-" ? "" : datums);
  return cell;
}

double largest(std::span<const double> values) {
  double most = 0.0;
  for (const double value : values) most = std::fmax(most, value);
  return most;
}

/// A note on the effects of features alone and together.
std::string together_note(const DrawingResult& found, std::size_t response, const NamedUnit& named) {
  const std::string alone = "effect: root mean square by the feature alone, over the poses; ";
  const double all = root_mean_square(found.rms.row(response));
  if (std::isnan(all)) return alone + "what they do together is not known here, because the study correlates errors";
  return fmt::format(
      "{}all of them together: {}, and {} where each location is divided between middle and tilt as is worst", alone,
      response_text(named, all), response_text(named, root_mean_square(found.rms_worst_division.row(response))));
}

}  // namespace

bool has_zone_shape(const StoredResult& result) {
  return result.drawing && result.study_text.find("\nzones = {") != std::string::npos &&
         result.study_text.find("\nzones = { distribution = \"normal\"") == std::string::npos;
}

std::vector<std::string> feature_of_each_error(const StoredResult& result) {
  std::vector<std::string> sources = names_of(result.factors);
  if (!result.drawing) return sources;
  for (std::string& source : sources) {
    for (std::size_t q = 0; q < result.drawing->features(); ++q) {
      if (!is_of_feature(*result.drawing, q, source)) continue;
      source = result.drawing->names[q];
      break;
    }
  }
  return sources;
}

std::optional<Table> drawing_table(const StoredResult& result, std::size_t response) {
  if (!result.drawing) return std::nullopt;
  const DrawingResult& found = *result.drawing;
  const NamedUnit& named = result.responses[response];
  const Unit& unit = display(named);
  if (!std::isfinite(found.effect(response, 0))) return std::nullopt;
  const auto in_unit = [&](double si) { return response_text(named, si); };
  Table table{
      .name = "features",
      .caption = fmt::format("What the features of the drawing do to {} in their zones, to first order", named.name),
      .columns = {},
      .notes = {together_note(found, response, named),
                fmt::format("worst case, with all features in their zones, to first order: {}; of the worst case: "
                            "each feature's part of it at the pose where it is largest",
                            in_unit(largest(found.worst_case.row(response)))),
                "zones in mm; other errors are not in these numbers"},
      .ranked = true};
  std::vector<std::size_t> rows = positions(found.features());
  const std::vector<std::string_view> instead = instead_of_zones(result);
  const auto some = [&](std::string_view what) { return std::ranges::find(instead, what) != instead.end(); };
  if (some("measured")) {
    table.notes.emplace_back(
        "measured: the effect is that of the standard deviation of the measured parts, without their mean; the worst "
        "case is that of the zone");
  }
  if (some("overridden")) {
    table.notes.emplace_back(
        "overridden: the study sets the sizes of some errors of the feature (errors.override), and the effect is that "
        "of these; the worst case is that of the zone");
  }
  std::ranges::stable_sort(rows, std::ranges::greater(), [&](std::size_t q) { return found.effect(response, q); });
  fill(table, rows,
       {{text_column("feature", "feature"), [&](std::size_t q) { return text_cell(found.names[q]); }},
        {text_column("location", "location or size"),
         [&](std::size_t q) {
           return zone_cell(result, q, instead[q], found.location(q), found.location_zone(q), found.location_datums(q));
         }},
        {text_column("orientation", "orientation"),
         [&](std::size_t q) {
           return zone_cell(result, q, instead[q], found.orientation(q), found.orientation_zone(q),
                            found.orientation_datums(q));
         }},
        {number_column("effect", "effect", unit.name),
         [&, response](std::size_t q) { return value_cell(found.effect(response, q), named); }},
        {percent_column("share", "share"),
         [&, response](std::size_t q) { return percent_cell(found.share(response, q)); }},
        {percent_column("worst_share", "of the worst case", 1),
         [&, response](std::size_t q) { return percent_cell(found.worst_share(response, q)); }}});
  return table;
}

}  // namespace poesy
