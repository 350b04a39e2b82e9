#include "models/file/physical.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace poesy::file {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// The quantity of each Dimension, in the order of that enumeration.
constexpr std::array<Physical, 7> kOfDimensions{{kLength,
                                                 kAngle,
                                                 {"a time", {.time = 1}, "s", "2 s"},
                                                 kNumber,
                                                 kForce,
                                                 kMoment,
                                                 {"an energy", kMoment.powers, "J", "2 J"}}};

/// Quantities with mass or time whose dimension has a name.
constexpr std::array<Physical, 7> kNamed{
    {kMass, kAcceleration, kForce, kMoment, kStiffness, kRotationalStiffness, kModulus}};

/// Returns true if the powers include mass or time, which no quantity of geometry has.
bool is_mechanical(const Powers& powers) { return powers.mass != 0 || powers.time != 0; }

/// A unit that may follow a number.
struct KnownUnit {
  std::string_view name;
  double si;
  Powers powers;
};

/// The dimensions whose units in studies (engine/base/units.h) are also units in expressions. Time is missing, because
/// its unit "h" (hour) could not be distinguished from a parameter with the name h.
constexpr std::array<Dimension, 4> kOfStudies{Dimension::length, Dimension::angle, Dimension::force, Dimension::moment};

constexpr std::array<KnownUnit, 22> kOthers{{{"N/m", 1.0, kStiffness.powers},
                                             {"N/mm", 1e3, kStiffness.powers},
                                             {"N/um", 1e6, kStiffness.powers},
                                             {"kN/mm", 1e6, kStiffness.powers},
                                             {"N m/rad", 1.0, kRotationalStiffness.powers},
                                             {"kN m/rad", 1e3, kRotationalStiffness.powers},
                                             {"N m/mrad", 1e3, kRotationalStiffness.powers},
                                             {"N m/deg", 1.0 / kDegree, kRotationalStiffness.powers},
                                             {"N m/arcmin", 60.0 / kDegree, kRotationalStiffness.powers},
                                             {"Pa", 1.0, kModulus.powers},
                                             {"kPa", 1e3, kModulus.powers},
                                             {"MPa", 1e6, kModulus.powers},
                                             {"GPa", 1e9, kModulus.powers},
                                             {"mm^2", 1e-6, kArea.powers},
                                             {"cm^2", 1e-4, kArea.powers},
                                             {"m^2", 1.0, kArea.powers},
                                             {"mm^4", 1e-12, kAreaMoment.powers},
                                             {"cm^4", 1e-8, kAreaMoment.powers},
                                             {"m^4", 1.0, kAreaMoment.powers},
                                             {"kg", 1.0, kMass.powers},
                                             {"g", 1e-3, kMass.powers},
                                             {"m/s^2", 1.0, kAcceleration.powers}}};

std::vector<KnownUnit> all_units() {
  std::vector<KnownUnit> list;
  for (const Unit& unit : units()) {
    if (std::ranges::find(kOfStudies, unit.dimension) == kOfStudies.end()) continue;
    list.push_back({unit.name, unit.si, physical(unit.dimension).powers});
  }
  list.insert(list.end(), kOthers.begin(), kOthers.end());
  return list;
}

/// An alternative spelling, in UTF-8, of a sequence of letters in a unit's name.
struct Sign {
  std::string_view part;
  std::string_view sign;
};

constexpr std::array<Sign, 3> kSigns{{{"um", "\xC2\xB5m"}, {"um", "\xCE\xBCm"}, {"deg", "\xC2\xB0"}}};

/// Returns true if a word may continue with this character.
bool goes_on(char c) {
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  return letter || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80;
}

/// The number of bytes of this unit's name at the beginning of the text; 0 if the text begins with something else.
std::size_t length_of(std::string_view name, std::string_view text) {
  const std::size_t size = text.size();
  while (!name.empty()) {
    const auto other = std::ranges::find_if(
        kSigns, [&](const Sign& one) { return name.starts_with(one.part) && text.starts_with(one.sign); });
    if (other == kSigns.end() && !text.starts_with(name.front())) return 0;
    text.remove_prefix(other == kSigns.end() ? 1 : other->sign.size());
    if (name.front() == ' ') text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    name.remove_prefix(other == kSigns.end() ? 1 : other->part.size());
  }
  return !text.empty() && goes_on(text.front()) ? 0 : size - text.size();
}

/// A product of units as text, without powers of 0: "m^2 s^-1".
std::string powers_text(std::span<const std::pair<std::string_view, int>> powers) {
  std::string text;
  for (const auto& [unit, power] : powers) {
    if (power == 0) continue;
    text += (text.empty() ? "" : " ") + std::string(unit) + (power == 1 ? "" : "^" + std::to_string(power));
  }
  return text;
}

}  // namespace

bool Powers::only_angle() const { return length == 0 && mass == 0 && time == 0; }

bool Powers::like(const Powers& other) const {
  const bool same = length == other.length && mass == other.mass && time == other.time;
  return same && (angle == other.angle || !only_angle());
}

const Physical& physical(Dimension dimension) { return kOfDimensions.at(static_cast<std::size_t>(dimension)); }

std::string dimension_text(const Powers& powers) {
  for (const Physical& geometric : {kNumber, kLength, kAngle}) {
    if (powers == geometric.powers) return std::string(geometric.name);
  }
  const auto named = std::ranges::find(kNamed, powers, &Physical::powers);
  if (named != kNamed.end()) return std::string(named->name);
  const auto& [length, angle, mass, time] = powers;
  using Each = std::array<std::pair<std::string_view, int>, 4>;
  return powers_text(is_mechanical(powers) ? Each{{{"kg", mass}, {"m", length}, {"s", time}, {"rad", angle}}}
                                           : Each{{{"length", length}, {"angle", angle}}});
}

std::optional<WrittenUnit> unit_at_begin(std::string_view text) {
  static const std::vector<KnownUnit> all = all_units();
  std::optional<WrittenUnit> longest;
  for (const KnownUnit& unit : all) {
    const std::size_t length = length_of(unit.name, text);
    if (length > (longest ? longest->length : 0)) longest = {unit.si, unit.powers, length};
  }
  return longest;
}

std::string known_units(const Powers& powers) {
  std::string list = unit_names(Dimension::length) + ", " + unit_names(Dimension::angle);
  if (!is_mechanical(powers)) return list;
  list += ", " + unit_names(Dimension::force) + ", " + unit_names(Dimension::moment);
  for (const KnownUnit& unit : kOthers) list += ", " + std::string(unit.name);
  return list;
}

}  // namespace poesy::file
