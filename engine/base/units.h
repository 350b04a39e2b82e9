#pragma once

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace poesy {

/// The physical dimension of a value; a number has no unit. Errors are lengths, angles or numbers. Only responses and
/// their limits can be forces, moments or energies.
enum class Dimension { length, angle, time, number, force, moment, energy };

std::span<const Dimension> all_dimensions();  ///< All dimensions, in the order of the enumeration.

/// A unit that study files may use.
struct Unit {
  std::string_view name;  ///< name in study files, such as "mm" or "N m"
  Dimension dimension;    ///< physical dimension
  double si;              ///< size of the unit in the SI unit of its dimension (m, rad, s, N, N m, J)
};

/// All units: m, cm, mm, um, in, mil, thou, rad, mrad, deg, arcmin, arcsec, s, ms, min, h, N, kN, N m, N mm, kN m, J,
/// mJ, uJ.
std::span<const Unit> units();

/// The unit with this name or one of the further spellings: a micro sign (U+00B5) or Greek mu (U+03BC) before m or J, a
/// degree sign (U+00B0), "inch". Null if there is no such unit.
const Unit* find_unit(std::string_view spelling);

/// The names of the units of one dimension, or of all dimensions, as a list: "m, cm, mm, um, in, mil, thou".
std::string unit_names(std::optional<Dimension> dimension = std::nullopt);

/// The name of a dimension: "length", "angle", "time", "number", "force", "moment" or "energy".
std::string_view name(Dimension dimension);
std::string with_article(Dimension dimension);  ///< The name with its article: "a length", "an angle".
std::string_view si_unit(Dimension dimension);  ///< The SI unit: "m", "rad", "s", "1", "N", "N m" or "J".
/// The unit in which reports show values: "mm", "deg", or for other dimensions the SI unit.
const Unit& display_unit(Dimension dimension);
/// The adjective for errors of this dimension: "linear" for a length, "angular" for an angle, "relative" for a number.
std::string_view error_kind(Dimension dimension);

/// The dimension with this SI unit; `number` for any other text.
Dimension dimension_of(std::string_view si_name);

/// A value with its dimension.
struct Quantity {
  double si = 0.0;                          ///< the value in the SI unit, or without unit
  Dimension dimension = Dimension::number;  ///< physical dimension
};

/// The exception for a text that is not of the form "NUMBER UNIT". what() is a clause without the name of the file.
class QuantityError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Reads "1.5 mm", "-0.5 rad", "10 um", "2 N m": a finite number and a unit that find_unit() knows. Throws
/// QuantityError with the reason. `wanted` only selects the known units that the message lists (empty: all); the
/// dimension of the result may differ from it.
Quantity parse_quantity(std::string_view text, std::optional<Dimension> wanted = std::nullopt);

/// Reads a text that is one finite number, independent of the locale; empty for any other text.
std::optional<double> parse_number(std::string_view text);

/// The reason why parse_number() cannot read a text, as a phrase that follows the text's name, such as "is not a finite
/// number".
std::string number_problem(std::string_view text);

std::string shortest(double value);  ///< The shortest text that reads back as the same number, such as "0.001".

/// A quantity in SI units, as text from which parse_quantity() reads the same quantity: "0.001 m", "0.5 rad".
std::string to_text(Quantity quantity);

/// A quantity in its display_unit(), to `digits` digits, such as "80 mm" or "1 deg".
std::string readable_text(Quantity quantity, int digits = 12);

}  // namespace poesy
