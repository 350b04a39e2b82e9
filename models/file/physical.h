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
  int length = 0;  ///< of m
  int angle = 0;   ///< of rad
  int mass = 0;    ///< of kg
  int time = 0;    ///< of s

  /// Whether values of these dimensions may be added. An angle is not a plain number, but in a product with other units
  /// rad is 1, so that N m/rad and N m are alike.
  bool like(const Powers& other) const;

  bool only_angle() const;  ///< Whether all powers other than that of rad are 0.

  bool operator==(const Powers&) const = default;  ///< Whether all powers are equal.
};

/// A quantity by its usual name.
struct Physical {
  std::string_view name;     ///< with its article: "a stiffness"
  Powers powers;             ///< its dimension
  std::string_view unit;     ///< the unit that names it in messages, "N/m"; empty if the name is enough
  std::string_view example;  ///< an example, "20 N/um"; empty for a number
};

inline constexpr Physical kLength{"a length", {.length = 1}, "", "1 mm"};                     ///< m
inline constexpr Physical kAngle{"an angle", {.angle = 1}, "", "1 deg"};                      ///< rad
inline constexpr Physical kNumber{"a number", {}, "", ""};                                    ///< 1
inline constexpr Physical kArea{"an area", {.length = 2}, "mm^2", "50 mm^2"};                 ///< m^2
inline constexpr Physical kAreaMoment{"an area moment", {.length = 4}, "mm^4", "2000 mm^4"};  ///< m^4
inline constexpr Physical kMass{"a mass", {.mass = 1}, "kg", "0.25 kg"};                      ///< kg

/// m/s^2
inline constexpr Physical kAcceleration{"an acceleration", {.length = 1, .time = -2}, "m/s^2", "9.81 m/s^2"};

/// N
inline constexpr Physical kForce{"a force", {.length = 1, .mass = 1, .time = -2}, "N", "5 N"};

/// N m
inline constexpr Physical kMoment{"a moment", {.length = 2, .mass = 1, .time = -2}, "N m", "0.5 N m"};

/// N/m
inline constexpr Physical kStiffness{"a stiffness", {.mass = 1, .time = -2}, "N/m", "20 N/um"};

/// N m/rad
inline constexpr Physical kRotationalStiffness{
    "a rotational stiffness", {.length = 2, .angle = -1, .mass = 1, .time = -2}, "N m/rad", "9000 N m/rad"};

/// Pa
inline constexpr Physical kModulus{"a modulus", {.length = -1, .mass = 1, .time = -2}, "Pa", "210 GPa"};

/// The quantity of a dimension of the engine.
const Physical& physical(Dimension dimension);

/// A dimension as text: "a length", "an angle", "a number", "length^2 angle^-1". With mass or time "a force" if the
/// quantity has a name, else "kg m^2 s^-1".
std::string dimension_text(const Powers& powers);

/// A unit at the beginning of a text.
struct WrittenUnit {
  double si;           ///< its size in SI
  Powers powers;       ///< its dimension
  std::size_t length;  ///< number of bytes of its name in the text
};

/// The unit with the longest name that begins the text: "N m/rad", not "N". A micro sign (U+00B5) or Greek mu (U+03BC)
/// may replace the u before m, a degree sign (U+00B0) deg, and several blanks one. Empty if no unit begins the text.
std::optional<WrittenUnit> unit_at_begin(std::string_view text);

/// The names of possible units of a quantity, for messages: those of length and angle, and also all others if mass or
/// time is among its powers.
std::string known_units(const Powers& powers);

}  // namespace poesy::file
