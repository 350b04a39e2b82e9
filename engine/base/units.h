#pragma once

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace poesy {

/// What a value measures; a number has no unit. Errors are lengths, angles or numbers. Only responses and their limits
/// can be forces, moments or energies.
enum class Dimension { length, angle, time, number, force, moment, energy };

std::span<const Dimension> all_dimensions();  ///< All dimensions, in the order of the enumeration.

/// A unit of study files: its name, and its size in SI (m, rad, s, N, N m, J).
struct Unit {
  std::string_view name;  ///< name in study files: "mm", "N m"
  Dimension dimension;    ///< what it measures
  double si;              ///< size in SI
};

/// All units: m, cm, mm, um, in, mil, thou, rad, mrad, deg, arcmin, arcsec, s, ms, min, h, N, kN, N m, N mm, kN m, J,
/// mJ, uJ.
std::span<const Unit> units();

/// The unit of this name, or of another spelling: a micro sign (U+00B5) or Greek mu (U+03BC) before m or J, a degree
/// sign (U+00B0). Null if there is none.
const Unit* find_unit(std::string_view spelling);

/// The names of the units of one dimension, or of all: "m, cm, mm, um, in, mil, thou".
std::string unit_names(std::optional<Dimension> dimension = std::nullopt);

std::string_view name(
    Dimension dimension);  ///< The name: "length", "angle", "time", "number", "force", "moment", "energy".
std::string with_article(Dimension dimension);  ///< The name with its article: "a length", "an angle".
std::string_view si_unit(Dimension dimension);  ///< The SI unit: "m", "rad", "s", "1", "N", "N m" or "J".
const Unit& display_unit(Dimension dimension);  ///< The unit that people read: "mm", "deg", else that of the SI.
std::string_view error_kind(
    Dimension dimension);  ///< The word for errors of this dimension: "linear", "angular", "relative".

/// The dimension with this SI unit; `number` for any other text.
Dimension dimension_of(std::string_view si_name);

/// A value with its dimension.
struct Quantity {
  double si = 0.0;                          ///< the value in the SI unit, or without unit
  Dimension dimension = Dimension::number;  ///< what it measures
};

/// A text is not of the form "NUMBER UNIT". what() is a clause without a place.
class QuantityError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Reads "1.5 mm", "-0.5 rad", "10 um", "2 N m": a finite number and a unit that find_unit() knows. Throws
/// QuantityError with the reason and the known units, of the wanted dimension or all.
Quantity parse_quantity(std::string_view text, std::optional<Dimension> wanted = std::nullopt);

/// Reads a whole text as one finite number, independent of the locale; empty for anything else.
std::optional<double> parse_number(std::string_view text);

/// The reason why parse_number() cannot read a text, as a phrase after its name: "is not a finite number".
std::string number_problem(std::string_view text);

std::string shortest(double value);  ///< The shortest text that reads back as the same number: "0.001".

std::string to_text(
    Quantity quantity);  ///< A quantity for a study file, which reads back exactly: "0.001 m", "0.5 rad".

/// A quantity in the unit that people read, to this many digits: "80 mm", "1 deg".
std::string readable_text(Quantity quantity, int digits = 12);

}  // namespace poesy
