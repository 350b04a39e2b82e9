#include "models/file/feature_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "engine/base/text.h"
#include "models/file/file_rows.h"

namespace poesy::file {
namespace {

void check_modifiers(const StudyValue& value, const std::string& text) {
  for (const std::string_view sign : {"\u24c2", "\u24c1", "(M)", "(L)"}) {
    if (text.find(sign) == std::string::npos) continue;
    value.fail("has the modifier " + std::string(sign) + ", which depends on the actual size, which is not modelled",
               "remove it; the zone is then the smallest that it allows");
  }
}

/// Throws if the text has a diameter sign or a plus-minus sign, as on drawings. The message says what to write instead.
void check_signs(std::string_view key, const StudyValue& value) {
  if (!value.is_text()) return;
  const std::string text = value.text();
  for (const std::string_view sign : {"\u00d8", "\u00f8", "\u2300"}) {
    if (text.find(sign) == std::string::npos) continue;
    value.fail(fmt::format("is '{}', with the sign {}", printable(text), sign),
               "write the number and its unit alone, e.g. \"0.05 mm\": around an axis or a point a zone is a diameter");
  }
  for (const std::string_view sign : {"+-", "+/-", "\u00b1"}) {
    if (text.find(sign) == std::string::npos) continue;
    value.fail(fmt::format("is '{}', with the sign {}", printable(text), sign),
               key == "tolerance" ? "write the number and its unit alone: tolerance = \"0.02 mm\" of a distance is "
                                    "+-0.02 mm"
                                  : "write the whole width of the zone, \"0.1 mm\" for +-0.05 mm");
  }
}

constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kPlusAndMinus = "+-";

/// Returns true if the text has a number with a sign directly before it, at or behind the place `from`. The sign of an
/// exponent, as in "1e-5", does not count. Precondition: from > 0.
bool has_signed_number(std::string_view text, std::size_t from) {
  for (std::size_t at = from; at + 1 < text.size(); ++at) {
    const bool is_exponent = text[at - 1] == 'e' || text[at - 1] == 'E';
    if (kPlusAndMinus.find(text[at]) != std::string_view::npos && !is_exponent &&
        kDigits.find(text[at + 1]) != std::string_view::npos)
      return true;
  }
  return false;
}

/// Returns true if the text is a tolerance of two limits, such as "+0.05 -0.02 mm" or "0 / -0.05 mm".
bool has_two_limits(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return false;
  const std::size_t digits = kPlusAndMinus.find(text[first]) == std::string_view::npos ? first : first + 1;
  const std::size_t end = std::min(text.find_first_not_of("0123456789.", digits), text.size());
  const std::size_t next = std::min(text.find_first_not_of(" /", end), text.size());
  if (end == digits || next + 1 >= text.size()) return false;
  if (kPlusAndMinus.find(text[next]) != std::string_view::npos && text.find_first_of(kDigits, next + 1) == next + 1)
    return true;
  return digits > first && has_signed_number(text, end);
}

/// Returns true if the text is a grade of ISO 286, such as "IT7", or a size with its zone, such as "905 js7".
bool is_zone_of_iso_286(std::string_view text) {
  const std::size_t begin = text.find_last_of(' ') + 1;
  const std::string_view size = trimmed(text.substr(0, begin));
  const std::string_view zone = text.substr(begin);
  const std::size_t digits = zone.find_first_of(kDigits);
  if (digits == 0 || digits > 2 || zone.find_first_not_of(kDigits, digits) != std::string_view::npos) return false;
  if (size.empty()) return zone.starts_with("IT");
  return size.find_first_not_of("0123456789.") == std::string_view::npos;
}

/// Throws if the tolerance of a distance is written as limits or as a zone of ISO 286.
void check_distance(const StudyValue& value) {
  const std::string text = value.is_text() ? std::string(trimmed(value.text())) : std::string();
  if (!value.is_list() && !has_two_limits(text) && !is_zone_of_iso_286(text)) return;
  value.fail(
      fmt::format("{}, but the tolerance of a distance is one length, +- half the width of its zone",
                  value.is_list() ? "is a list" : "is '" + printable(text) + "'"),
      "write half the width, e.g. \"0.035 mm\" for -0.02 mm and 0.05 mm, and in the study what is not symmetric: "
      "errors.override.ERROR = { distribution = \"normal\", limits = [\"-0.02 mm\", \"0.05 mm\"], sigmas = 3 }, or a "
      "mean");
}

/// The content of a zone's table, as written.
struct WrittenZone {
  std::optional<Expression> size;
  std::string datums;
};

const Keys<WrittenZone, Nothing>& zone_keys() {
  static const Keys<WrittenZone, Nothing> keys{
      .paths = {"limb.features.ZONE"},
      .meaning = "A zone with its datums.",
      .rows = {needed("zone", kept("length", expression, &WrittenZone::size), "\"0.05 mm\"",
                      "Its width, or its diameter around an axis or a point; or \"general\", by [drawing]."),
               optional("datums", text_at(&WrittenZone::datums), "none",
                        "The datums of the drawing, for tables: \"A|B\". The feature is toleranced in the frame of "
                        "its part.")}};
  return keys;
}

void read_zone(std::string_view key, const StudyValue& value, FeatureLines& feature) {
  WrittenZone written;
  if (value.is_section()) {
    const auto zone = value.section().find("zone");
    if (zone) check_signs(key, *zone);
    if (zone && key == "tolerance") check_distance(*zone);
    read_keys(zone_keys(), value.section(), written, Nothing{});
  } else {
    check_signs(key, value);
    if (key == "tolerance") check_distance(value);
    written.size = expression(value);
  }
  check_modifiers(value, written.size->text);
  feature.zones.push_back({key, *written.size, written.datums});
}

template <std::size_t kPosition>
void read_zone_at(const StudyValue& value, FeatureLines& feature) {
  read_zone(zone_traits()[kPosition].key, value, feature);
}

void read_at(const StudyValue& value, FeatureLines& feature) {
  if (value.is_text()) {
    feature.at_point = reference(value);
  } else {
    feature.at = point(value);
  }
}

void read_size(const StudyValue& value, FeatureLines& feature) {
  for (const StudyValue& side : value.list(2, "write its sides along x and y, e.g. [\"60 mm\", \"40 mm\"]")) {
    feature.size.push_back(expression(side));
  }
}

std::string read_along(const StudyValue& value) {
  constexpr std::array<std::string_view, 2> kAxes{"x", "y"};
  return std::string(kAxes[value.word(kAxes)]);
}

/// Throws for a tolerance of form: straightness, roundness or cylindricity.
void refuse_form(const StudyValue& value, FeatureLines&) {
  value.fail("is the form of one surface, which rigid parts do not have",
             "remove it, or give the location or the orientation of the feature");
}

/// Throws for concentricity, the name that drawings use for coaxiality of centres of circles.
void refuse_concentricity(const StudyValue& value, FeatureLines&) {
  value.fail("has the sign of coaxiality, by which it is known here",
             "write coaxiality of an axis, or position of a point");
}

std::optional<std::size_t> read_axis(const StudyValue& value) {
  return static_cast<std::size_t>(value.whole_number(1, 3));
}

template <std::size_t... kPositions>
std::vector<Row<FeatureLines>> zone_rows(std::index_sequence<kPositions...>) {
  constexpr std::string_view kMeaning =
      "A zone of the drawing: a length, \"general\", or { zone = \"0.05 mm\", datums = \"A|B\" }. A feature has at "
      "most one of location and one of orientation.";
  return {optional("", read_by("length or table", &read_zone_at<kPositions>), "none", kMeaning)...};
}

/// The kinds of features that may have a zone of this name.
std::vector<std::string_view> bearers(std::string_view zone) {
  if (zone == "tolerance") return {"distance"};
  if (zone == "flatness" || zone == "profile") return {"plane"};
  if (zone_traits(zone).of == ZoneClass::orientation || zone == "runout") return {"axis", "plane"};
  return {"axis", "plane", "point"};
}

const Keys<FeatureLines, Nothing>& feature_keys() {
  using F = FeatureLines;
  static const Keys<F, Nothing> keys = [] {
    const std::vector<std::string_view> placed{"axis", "plane", "point"};
    Keys<F, Nothing> made{
        .paths = {"limb.features"},
        .meaning =
            "A feature of a part of the limb, at home and in the base frame. It makes errors, all lengths: of an axis "
            "NAME_x, NAME_y (its middle) and NAME_lean_x, NAME_lean_y (its far end against its near end); of a plane "
            "NAME_z and NAME_lift_x, NAME_lift_y (an edge; the other one goes down by as much); of a point NAME_x, "
            "NAME_y, NAME_z; of a distance NAME. The limb's number is behind them.",
        .chooser = "kind",
        .owner = "a feature of kind",
        .rows = {
            needed("kind",
                   word_at<FeatureWord>({{FeatureWord::axis, "a bore, a pin or a rail"},
                                         {FeatureWord::plane, "a face, or the middle plane of a slot"},
                                         {FeatureWord::point, "the centre of a ball"},
                                         {FeatureWord::distance, "a length, as of a rod"}},
                                        &F::kind),
                   "\"axis\"", "What it is."),
            needed("name", kept("text", read_name, &F::name), "\"bore\"", "Its name, once in a limb."),
            needed("joint", kept("text", reference, &F::joint), "\"A\"", "The joint of the limb to which it belongs."),
            optional("axis", kept("integer", read_axis, &F::axis),
                     "the first axis; with part = \"after\" the last one of S and C",
                     "Which axis of a joint that has several."),
            optional("part",
                     word_at<PartSide>(
                         {{PartSide::before, "the part towards `from`"}, {PartSide::after, "the part towards `to`"}},
                         &F::part),
                     "`\"before\"`", "The part that bears it, in whose frame its errors are."),
            optional("at", read_by("point", read_at), "the joint's point",
                     "Its middle: [x, y, z], or the name of a joint or point."),
            needed("length", kept("length", expression, &F::length), "\"30 mm\"", "The length of the axis.", {"axis"}),
            optional("size", read_by("list of lengths", read_size), "", "Sides of a rectangular plane along x and y.",
                     {"plane"}),
            optional("diameter", kept("length", expression, &F::diameter), "", "Without `size`: of a round plane.",
                     {"plane"}),
            needed("direction", kept("direction", direction, &F::direction), "[1, 0, 0]",
                   "Along which the distance is measured: its far end is at the joint.", {"distance"}),
            optional("nominal_size", kept("length", expression, &F::nominal_size), "none",
                     "How long the distance is, for tables and for a general tolerance.", {"distance"}),
            optional("z", kept("direction", direction, &F::z), "the joint's axis",
                     "Along the axis, or normal to the plane.", placed),
            optional("x", kept("direction", direction, &F::x), "that of the joint's frame",
                     "Its x axis, made perpendicular to z.", placed),
            optional("shape",
                     word_at<ZoneShape>({{ZoneShape::usual, "around the axis or the point"},
                                         {ZoneShape::planes, "between two planes; `along` is across them"}},
                                        &F::shape),
                     "`\"usual\"`", "The shape of its zones.", {"axis", "point"}),
            optional("along", kept("text", read_along, &F::along), "", "With shape = \"planes\": \"x\" or \"y\".",
                     {"axis", "point"})}};
    std::vector<Row<F>> zones = zone_rows(std::make_index_sequence<11>());
    for (std::size_t k = 0; k < zones.size(); ++k) {
      zones[k].name = zone_traits()[k].key;
      zones[k].only_for = bearers(zones[k].name);
      made.rows.push_back(std::move(zones[k]));
    }
    for (const std::string_view form : {"straightness", "roundness", "cylindricity"}) {
      made.rows.push_back(
          optional(form, read_by("none", refuse_form), "", "Refused, because rigid parts have no form."));
    }
    made.rows.push_back(optional("concentricity", read_by("none", refuse_concentricity), "",
                                 "Refused: it is called `coaxiality` here, and `position` of a point."));
    return made;
  }();
  return keys;
}

/// Throws if a feature has two zones of one class, or a flatness and another zone.
void check_zones(const FeatureLines& feature) {
  for (std::size_t k = 0; k < feature.zones.size(); ++k) {
    const ZoneLines& zone = feature.zones[k];
    for (std::size_t other = 0; other < k; ++other) {
      const ZoneLines& first = feature.zones[other];
      const FeatureKind kind = kind_of(feature);
      const bool is_same = zone_class(zone.key, kind) == zone_class(first.key, kind);
      const bool has_flatness = zone.key == "flatness" || first.key == "flatness";
      if (!is_same && !has_flatness) continue;
      throw InputError(
          zone.size.place,
          feature.key + " '" + feature.name + "' has " + std::string(first.key) + " and " + std::string(zone.key),
          has_flatness ? "remove the flatness, because the other zone contains the form"
                       : "keep the one that decides: a feature has one zone of location and one of "
                         "orientation");
    }
  }
}

/// Throws if a key for a feature's size or shape is missing, or contradicts another key.
void check_shape(const FeatureLines& feature) {
  const auto fail = [&](const std::string& problem, std::string_view remedy) {
    throw InputError(feature.place, feature.key + " '" + feature.name + "' " + problem, remedy);
  };
  if (feature.kind == FeatureWord::plane && feature.size.empty() == !feature.diameter) {
    fail(feature.diameter ? "has size and diameter" : "has no size",
         "write size = [\"60 mm\", \"40 mm\"] for a rectangle, or diameter = \"50 mm\"");
  }
  const bool has_planes = feature.shape == ZoneShape::planes;
  if (has_planes && feature.along.empty()) fail("has zones between planes", "write along = \"x\" or \"y\"");
  if (!has_planes && !feature.along.empty()) fail("has along", "write shape = \"planes\" too, or remove it");
  const bool is_rectangle = feature.kind == FeatureWord::plane && !feature.diameter;
  for (const ZoneLines& zone : feature.zones) {
    if (is_rectangle && (zone.key == "runout" || zone.key == "total_runout")) {
      fail("has " + std::string(zone.key) + ", which is measured on a round face", "write its diameter");
    }
  }
}

const Keys<ClearanceLines, Nothing>& clearance_keys() {
  using C = ClearanceLines;
  static const Keys<C, Nothing> keys{
      .paths = {"limb.clearances"},
      .meaning =
          "The clearance of a pin in the bore of a joint: errors NAME_x, NAME_y, NAME_lean_x and NAME_lean_y like "
          "those of an axis, drawn anew at each pose.",
      .rows = {
          needed("name", kept("text", read_name, &C::axis, &FeatureLines::name), "\"play\"",
                 "Its name, once among clearances and features of a limb."),
          needed("joint", kept("text", reference, &C::axis, &FeatureLines::joint), "\"A\"", "The joint that is loose."),
          optional("axis", kept("integer", read_axis, &C::axis, &FeatureLines::axis), "the first axis",
                   "Which axis of a joint that has several."),
          needed("length", kept("length", expression, &C::axis, &FeatureLines::length), "\"40 mm\"",
                 "The length over which the pin is in the bore."),
          optional("fit", text_at(&C::fit), "", "Size and fit of ISO 286: \"8 H7/g6\", holes H and shafts d to h."),
          optional("least", kept("length", expression, &C::least), "", "Without `fit`: the least clearance."),
          optional("most", kept("length", expression, &C::most), "", "Without `fit`: the largest clearance."),
          optional("contact",
                   word_at<Contact>({{Contact::boundary, "the pin touches the bore, in any direction"},
                                     {Contact::uniform, "the pin is anywhere in the bore"}},
                                    &C::contact),
                   "`\"boundary\"`", "Where the pin is.")}};
  return keys;
}

}  // namespace

std::string_view name(FeatureWord kind) {
  constexpr std::array<std::string_view, 4> kNames{"axis", "plane", "point", "distance"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string_view name(Contact contact) { return contact == Contact::boundary ? "boundary" : "uniform"; }

std::string_view name(PartSide side) { return side == PartSide::before ? "before" : "after"; }

std::string_view name(ZoneShape shape) { return shape == ZoneShape::usual ? "usual" : "planes"; }

std::vector<FeatureLines> read_features(const StudyValue& value) {
  std::vector<FeatureLines> list;
  std::unordered_set<std::string> names;
  for (const StudyValue& element : value.list()) {
    FeatureLines feature;
    feature.key = element.full_name();
    feature.place = element.place();
    const StudySection section = element.section();
    read_keys(feature_keys(), section, feature, Nothing{});
    const StudyValue name = section.require("name");
    add_name({feature.name, name.full_name(), name.place()}, names, "feature of this limb");
    check_shape(feature);
    check_zones(feature);
    list.push_back(std::move(feature));
  }
  return list;
}

FeatureKind kind_of(const FeatureLines& lines) {
  switch (lines.kind) {
    case FeatureWord::axis:
      return FeatureKind::axis;
    case FeatureWord::plane:
      return lines.diameter ? FeatureKind::round : FeatureKind::rectangle;
    case FeatureWord::point:
      return FeatureKind::point;
    case FeatureWord::distance:
      break;
  }
  return FeatureKind::distance;
}

std::vector<ClearanceLines> read_clearances(const StudyValue& value) {
  std::vector<ClearanceLines> list;
  for (const StudyValue& element : value.list()) {
    ClearanceLines clearance;
    clearance.axis.key = element.full_name();
    clearance.axis.place = element.place();
    const StudySection section = element.section();
    read_keys(clearance_keys(), section, clearance, Nothing{});
    if (const auto fit = section.find("fit")) {
      clearance.fit_place = fit->place();
      for (const std::string_view key : {"least", "most"}) section.refuse(key, "a clearance with a fit");
    } else if (!clearance.least || !clearance.most) {
      element.fail("has no fit", "write fit = \"8 H7/g6\", or least = \"5 um\" and most = \"29 um\"");
    }
    list.push_back(std::move(clearance));
  }
  return list;
}

StudyTables feature_tables() {
  return {described(feature_keys()), described(zone_keys()), described(clearance_keys())};
}

}  // namespace poesy::file
