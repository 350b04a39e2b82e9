#include "engine/kinds/allocation/zone_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <string_view>
#include <utility>

#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/kinds/allocation/summary.h"
#include "engine/model/feature.h"
#include "engine/report/signs.h"

namespace poesy::allocation {
namespace {

bool is_zone(const Result& found, std::size_t n) { return !found.zone_key(n).empty(); }

std::string sign_of(const Result& found, std::size_t n) {
  return is_zone(found, n) ? std::string(zone_traits(found.zone_key(n)).sign) : std::string(kPlusMinus);
}

/// The feature of a part, "1-3 rail", or the part's name if it is not a zone.
std::string feature_text(const Result& found, std::size_t n) {
  return is_zone(found, n) ? found.zone_limbs(n) + " " + found.zone_feature(n) : found.part_names[n];
}

/// The sign before a tolerance on the drawing: plus-minus for a distance and for a part that is not a zone, the sign of
/// the diameter of a cylinder or a sphere, nothing for the width of a zone.
std::string_view before_number(const Result& found, std::size_t n) {
  if (!is_zone(found, n) || found.zone_shape(n) == "interval") return kPlusMinus;
  if (found.zone_shape(n) == "sphere") return kSphereDiameter;
  return found.zone_shape(n) == "cylinder" ? kDiameter : std::string_view();
}

std::string zone_text(const Result& found, std::size_t n) {
  const std::string& unit = found.part_unit(n);
  return fmt::format("{}{} {}", before_number(found, n), drawing_number(found.tolerance(n), unit),
                     display_unit(dimension_of(unit)).name);
}

/// A cell with the tolerance of part n as text, and for a zone also as a tolerance frame. A distance has no frame.
Cell zone_cell(const Result& found, std::size_t n) {
  Cell cell = text_cell(zone_text(found, n));
  if (!is_zone(found, n) || found.zone_shape(n) == "interval") return cell;
  const std::string zone(before_number(found, n));
  cell.boxes = frame_boxes(sign_of(found, n), zone + drawing_number(found.tolerance(n), found.part_unit(n)),
                           found.zone_datums(n));
  return cell;
}

/// A column that is shown only in text output, because on a page the tolerance frame already shows its content.
Column framed_column(std::string name, std::string heading) {
  Column column = text_column(std::move(name), std::move(heading));
  column.only_text = true;
  return column;
}

/// The size of a feature in the table: "500 mm", "60 x 40 mm", or the diameter of a round plane. "-" if none is known.
std::string over_text(const Result& found, std::size_t n) {
  if (!is_zone(found, n) || std::isnan(found.zone_length(n))) return "-";
  const Unit& unit = display_unit(Dimension::length);
  const auto in_unit = [&](double si) { return number_text(si / unit.si); };
  const std::string length = in_unit(found.zone_length(n));
  if (std::isnan(found.zone_width(n))) return fmt::format("{} {}", length, unit.name);
  if (found.zone_width(n) == 0.0) return fmt::format("{}{} {}", kDiameter, length, unit.name);
  return fmt::format("{} x {} {}", length, in_unit(found.zone_width(n)), unit.name);
}

/// Whether two parts are the orientation and the location of the same features.
bool are_of_one_feature(const Result& found, std::size_t a, std::size_t b) {
  return a != b && is_zone(found, a) && is_zone(found, b) && found.zone_feature(a) == found.zone_feature(b) &&
         found.zone_limbs(a) == found.zone_limbs(b);
}

/// Remarks on a part: that the drawing does not need the orientation of its feature, that its tolerance is at a bound,
/// or that its tolerance was given.
std::string remark(const Result& found, std::size_t n) {
  std::vector<std::string> words;
  for (std::size_t other = 0; other < found.parts(); ++other) {
    if (!are_of_one_feature(found, n, other) || !found.is_left_out(other)) continue;
    words.push_back(found.zone_key(other) + ": not needed");
  }
  constexpr std::array<std::string_view, 4> kBounds{"", "at its lower bound", "at its upper bound", "given"};
  if (found.bound(n) != 0) words.emplace_back(kBounds.at(found.bound(n)));
  return fmt::format("{}", fmt::join(words, "; "));
}

/// Whether a part is an orientation whose location is also a part.
bool follows_another(const Result& found, std::size_t n) {
  if (!is_zone(found, n)) return false;
  // Run-out is a location tolerance for an axis, and an orientation tolerance for other features.
  const FeatureKind kind = found.zone_shape(n) == "cylinder" ? FeatureKind::axis : FeatureKind::round;
  if (zone_class(found.zone_key(n), kind) != ZoneClass::orientation) return false;
  for (std::size_t other = 0; other < found.parts(); ++other) {
    if (are_of_one_feature(found, n, other)) return true;
  }
  return false;
}

}  // namespace

std::vector<FilledColumn> zone_columns(const Result& found) {
  return {{text_column("feature", "feature"), [&](std::size_t n) { return text_cell(feature_text(found, n)); }},
          {framed_column("symbol", ""),
           [&](std::size_t n) { return text_cell(sign_of(found, n) == kPlusMinus ? "" : sign_of(found, n)); }},
          {text_column("zone", "zone"), [&](std::size_t n) { return zone_cell(found, n); }},
          {framed_column("datums", "to"),
           [&](std::size_t n) { return text_cell(found.zone_datums(n).empty() ? "-" : found.zone_datums(n)); }},
          {text_column("over", "over"), [&](std::size_t n) { return text_cell(over_text(found, n)); }}};
}

std::vector<FilledColumn> inside_columns(const Result& found) {
  return {{percent_column("inside", "inside", 1), [&](std::size_t n) { return percent_cell(found.zone_inside(n)); }},
          {text_column("remark", "remark"), [&](std::size_t n) { return text_cell(remark(found, n)); }}};
}

std::vector<std::size_t> drawn_parts(const Result& found, const std::vector<std::size_t>& order) {
  std::vector<std::size_t> drawn;
  for (const std::size_t n : order) {
    if (found.is_left_out(n) || follows_another(found, n)) continue;
    drawn.push_back(n);
    for (std::size_t other = 0; other < found.parts(); ++other) {
      if (are_of_one_feature(found, n, other) && !found.is_left_out(other)) drawn.push_back(other);
    }
  }
  return drawn;
}

std::string zones_note(const Result& found) {
  std::set<double> sigmas;
  for (std::size_t n = 0; n < found.parts(); ++n) {
    if (is_zone(found, n)) sigmas.insert(found.sigmas(n));
  }
  const std::string first = number_text(*sigmas.begin());
  const std::string range = sigmas.size() == 1 ? first : first + " to " + number_text(*sigmas.rbegin());
  return fmt::format(
      "half a zone, or T of a distance: {} standard deviations of a coordinate at the extreme points of a feature; "
      "inside: the share of features that are inside their zone; zones are rounded down to four digits",
      range);
}

CsvTable drawing_csv(const Result& found) {
  constexpr int kDigits = 12;  // enough digits, but too few to show the rounding of unit conversion
  const auto text = [](double value) { return std::isnan(value) ? std::string() : number_text(value, kDigits); };
  const auto in_mm = [=](double si) { return text(1e3 * si); };
  const auto or_none = [](const std::string& one) { return one.empty() ? std::string("none") : one; };
  CsvTable table{
      "drawing", {"limbs", [&found, or_none](std::size_t n) { return or_none(found.zone_limbs(n)); }}, found.parts()};
  table.has = [&found](std::size_t n) { return !found.is_left_out(n); };
  const auto add = [&](const char* name, std::function<std::string(std::size_t)> cell) {
    table.more.push_back({name, std::move(cell)});
  };
  add("feature", [&found](std::size_t n) { return is_zone(found, n) ? found.zone_feature(n) : found.part_names[n]; });
  add("symbol", [&found](std::size_t n) { return is_zone(found, n) ? found.zone_key(n) : std::string("tolerance"); });
  add("sign", [&found](std::size_t n) { return sign_of(found, n); });
  add("zone_mm", [&found](std::size_t n) {
    return found.part_unit(n) == "m" ? drawing_number(found.tolerance(n), "m") : std::string();
  });
  add("shape", [&found](std::size_t n) { return is_zone(found, n) ? found.zone_shape(n) : std::string("interval"); });
  add("datums", [&found, or_none](std::size_t n) { return or_none(found.zone_datums(n)); });
  add("length_mm", [&found, in_mm](std::size_t n) { return in_mm(found.zone_length(n)); });
  add("cost", [&found, text](std::size_t n) { return text(found.cost(n)); });
  add("share_of_cost", [&found, text](std::size_t n) { return text(found.share(n)); });
  add("share_of_mean_square", [&found, text](std::size_t n) { return text(found.mean_square_share(n)); });
  add("sigmas", [&found, text](std::size_t n) { return text(found.sigmas(n)); });
  add("inside", [&found, text](std::size_t n) { return text(found.zone_inside(n)); });
  add("grade", [&found, or_none](std::size_t n) { return or_none(found.chosen(n)); });
  add("remark", [&found, or_none](std::size_t n) { return or_none(remark(found, n)); });
  add("angle_deg", [&found](std::size_t n) {
    return found.part_unit(n) == "rad" ? drawing_number(found.tolerance(n), "rad") : std::string();
  });
  return table;
}

}  // namespace poesy::allocation
