#include "models/file/general.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "engine/base/text.h"
#include "engine/base/units.h"
#include "models/file/file_rows.h"

namespace poesy::file {
namespace {

constexpr std::string_view kLengths = "ISO 2768-1:1989 ";
constexpr std::string_view kZones = "ISO 2768-2:1989 ";
constexpr std::string_view kLengthClasses = "fmcv";
constexpr std::string_view kZoneClasses = "HKL";
constexpr std::string_view kStateIt = "write the length that is meant, because nothing is assumed in silence";

/// The index in `classes` of the letter at the end of a text such as "ISO 2768-1:1989 m"; none if the letter is not
/// among them.
std::optional<std::size_t> class_in(std::string_view text, std::string_view standard, std::string_view classes) {
  if (text.size() != standard.size() + 1 || !text.starts_with(standard)) return std::nullopt;
  const std::size_t at = classes.find(text.back());
  return at == std::string_view::npos ? std::nullopt : std::optional(at);
}

/// Sets the class of one part of the standard ISO 2768; throws if it is set already.
template <class Class>
void set(std::optional<Class>& to, std::size_t position, const Reference& text) {
  if (to) throw InputError(text.place, text.key + " names a part of ISO 2768 twice", "keep one class of each part");
  to = static_cast<Class>(position);
}

void read_general(const StudyValue& value, GeneralLines& general) {
  for (const Reference& text : references(value)) {
    if (const auto length = class_in(text.name, kLengths, kLengthClasses)) {
      set(general.lengths, *length, text);
    } else if (const auto zone = class_in(text.name, kZones, kZoneClasses)) {
      set(general.zones, *zone, text);
    } else {
      throw InputError(text.place, text.key + " is '" + printable(text.name) + "'",
                       "write \"ISO 2768-1:1989 m\" (f, m, c or v) for distances and \"ISO 2768-2:1989 K\" (H, K or L) "
                       "for perpendicularity, flatness, symmetry and run-out, with the year, because ISO 22081, which "
                       "replaced Part 2, has no table");
    }
  }
}

const Keys<GeneralLines, Nothing>& drawing_keys() {
  static const Keys<GeneralLines, Nothing> keys{
      .paths = {"drawing"},
      .meaning = "What the drawing says of all parts.",
      .rows = {optional(
          "general", read_by("text or list of texts", read_general), "none",
          "The general tolerances by which zones written \"general\" have their size: \"ISO 2768-1:1989 m\" (classes "
          "f, m, c, v) for the tolerance of distances, by their nominal_size; \"ISO 2768-2:1989 K\" (H, K, L) for "
          "perpendicularity, flatness and symmetry, by the length, longer side or diameter of the feature, and for "
          "run-out. Other zones have no general size.")}};
  return keys;
}

/// The table of ISO 2768-2 for a zone; none if the standard has no such table.
std::optional<GeneralZone> table_of(std::string_view key) {
  if (key == "perpendicularity") return GeneralZone::perpendicularity;
  if (key == "flatness") return GeneralZone::flatness;
  if (key == "symmetry") return GeneralZone::symmetry;
  return key == "runout" ? std::optional(GeneralZone::runout) : std::nullopt;
}

[[noreturn]] void fail(const ZoneLines& zone, const std::string& problem, std::string_view remedy = kStateIt) {
  throw InputError(zone.size.place, zone.size.key + " is \"general\", " + problem, remedy);
}

/// The value found in a table; throws with the reason if there is none.
double checked(std::optional<double> found, const ZoneLines& zone, double size, std::string_view standard) {
  if (found) return *found;
  fail(zone, "but " + std::string(standard.substr(0, standard.find(':'))) + " has no value for this class at " +
                 readable_text({size, Dimension::length}, 6));
}

template <class Class>
Class stated(const std::optional<Class>& general, const ZoneLines& zone, std::string_view standard, char of) {
  if (general) return *general;
  fail(zone, "but the file does not say of which class",
       "write general = \"" + std::string(standard) + of + "\" in [drawing], or the length that is meant");
}

}  // namespace

GeneralLines read_drawing(const StudyValue& value) {
  GeneralLines general;
  read_keys(drawing_keys(), value.section(), general, Nothing{});
  return general;
}

StudyTable drawing_keys_table() { return described(drawing_keys()); }

double general_size(const ZoneLines& zone, const Feature& feature, const GeneralLines& general) {
  const double size = std::max(feature.size[0], feature.size[1]);
  if (zone.key == "tolerance") {
    const GeneralLengthClass of = stated(general.lengths, zone, kLengths, 'm');
    if (!(size > 0.0)) {
      fail(zone, "but the distance has no nominal_size", "write it, e.g. nominal_size = \"340 mm\", or the tolerance");
    }
    return checked(general_length_tolerance(size, of), zone, size, kLengths);
  }
  if (zone.key == "parallelism") {
    fail(zone,
         "but ISO 2768-2 limits a parallelism by the tolerance of the distance of both features, which is not known");
  }
  const std::optional<GeneralZone> table = table_of(zone.key);
  if (!table) {
    fail(zone, "but ISO 2768-2 never held for position, coaxiality, angularity, profile and total run-out");
  }
  const GeneralZoneClass of = stated(general.zones, zone, kZones, 'K');
  if (!(size > 0.0)) fail(zone, "but a point has no length, by which ISO 2768-2 gives its zone");
  return checked(general_zone(*table, size, of), zone, size, kZones);
}

}  // namespace poesy::file
