#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/units.h"

/// The quantities of a mechanism file and their units.
namespace poesy::file {

/// A dimension as a product of powers of m, rad, kg and s.
struct Powers {
  int length = 0;  ///< power of m
  int angle = 0;   ///< power of rad
  int mass = 0;    ///< power of kg
  int time = 0;    ///< power of s

  /// Returns true if values of these dimensions may be added. An angle alone differs from a plain number. In a product
  /// with other units rad counts as 1, so that N m/rad and N m are alike.
  bool like(const Powers& other) const;

  bool only_angle() const;  ///< Returns true if all powers except that of rad are 0.

  bool operator==(const Powers&) const = default;  ///< Returns true if all powers are equal.
};

/// A kind of quantity with its usual name.
struct Physical {
  std::string_view name;     ///< name with its article: "a stiffness"
  Powers powers;             ///< dimension
  std::string_view unit;     ///< unit that messages add to the name, "N/m"; empty if the name is enough
  std::string_view example;  ///< an example: "20 N/um"; empty for a number
};

inline constexpr Physical kLength{"a length", {.length = 1}, "", "1 mm"};                     ///< unit m
inline constexpr Physical kAngle{"an angle", {.angle = 1}, "", "1 deg"};                      ///< unit rad
inline constexpr Physical kNumber{"a number", {}, "", ""};                                    ///< unit 1
inline constexpr Physical kArea{"an area", {.length = 2}, "mm^2", "50 mm^2"};                 ///< unit m^2
inline constexpr Physical kAreaMoment{"an area moment", {.length = 4}, "mm^4", "2000 mm^4"};  ///< unit m^4
inline constexpr Physical kMass{"a mass", {.mass = 1}, "kg", "0.25 kg"};                      ///< unit kg

/// Unit m/s^2.
inline constexpr Physical kAcceleration{"an acceleration", {.length = 1, .time = -2}, "m/s^2", "9.81 m/s^2"};

/// Unit N.
inline constexpr Physical kForce{"a force", {.length = 1, .mass = 1, .time = -2}, "N", "5 N"};

/// Unit N m.
inline constexpr Physical kMoment{"a moment", {.length = 2, .mass = 1, .time = -2}, "N m", "0.5 N m"};

/// Unit N/m.
inline constexpr Physical kStiffness{"a stiffness", {.mass = 1, .time = -2}, "N/m", "20 N/um"};

/// Unit N m/rad.
inline constexpr Physical kRotationalStiffness{
    "a rotational stiffness", {.length = 2, .angle = -1, .mass = 1, .time = -2}, "N m/rad", "9000 N m/rad"};

/// Unit Pa.
inline constexpr Physical kModulus{"a modulus", {.length = -1, .mass = 1, .time = -2}, "Pa", "210 GPa"};

/// The quantity that corresponds to a Dimension of the engine.
const Physical& physical(Dimension dimension);

/// A dimension as text: "a length", "an angle", "a number", "length^2 angle^-1". If mass or time is among the powers,
/// the text is the name of the quantity, such as "a force", or "kg m^2 s^-1" if it has no name.
std::string dimension_text(const Powers& powers);

/// A unit that was found at the beginning of a text.
struct WrittenUnit {
  double si;           ///< value of the unit in SI
  Powers powers;       ///< dimension
  std::size_t length;  ///< number of bytes of the unit's name in the text
};

/// Finds the unit with the longest name at the beginning of a text: "N m/rad", not "N". In the text a micro sign
/// (U+00B5) or a Greek mu (U+03BC) counts as u before m, a degree sign (U+00B0) as deg, and several blanks as one.
/// Returns no value if the text does not begin with a unit.
std::optional<WrittenUnit> unit_at_begin(std::string_view text);

/// The names of possible units of a quantity, for messages: units of length and angle, and all other units too if mass
/// or time is among the powers.
std::string known_units(const Powers& powers);

}  // namespace poesy::file
