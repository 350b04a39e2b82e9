#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/model/model.h"
#include "models/file/physical.h"

/// Expressions in mechanism files. They consist of numbers, parameters of the geometry, + - * / ^ ( ), sqrt, sin, cos,
/// tan, atan, atan2, pi, and units after numbers: "a + 20 mm", "pi * d^4 / 64", "20 N/um". Dimensions are evaluated
/// together with values, so a message names the place inside the expression.
///
/// A name directly after a number is a unit: "2 g" is two grams even if a parameter is called g, and "2 * g" is twice
/// the parameter. So a parameter may have the name of a unit, except of a unit of length or angle. A unit is written
/// without blanks around / and ^, and its power belongs to it: "2 m/s^2" is an acceleration, but "2 m / s^2" divides by
/// a parameter. "5 mm^2" is five square millimetres, "(5 mm)^2" is 25. An exponent is a whole number; -a^2 is -(a^2).
///
/// poesy has its own parser because muparser (Debian) computes only with doubles. A second evaluation with other units
/// of length and angle would show the dimension of a value, but not of zero ("offset + 1 deg" with offset = 0 mm). If
/// the doubles encoded dimensions, new operators for them would take as much code as a parser and could not name the
/// place of a mistake.
namespace poesy::file {

/// A quantity as written in a mechanism file. It has no value yet, because a study may change the geometry.
struct Expression {
  std::string text;     ///< the expression as written: "a + 20 mm"
  std::string key;      ///< key in the file, for messages: "limb[0].joints[1].at[2]"
  Place place;          ///< place of the value in the file
  bool quoted = false;  ///< if true, the text begins one column after the place
};

/// A value with its dimension.
struct Value {
  double si = 0.0;     ///< value in m, rad, kg, s and their powers
  Powers powers = {};  ///< dimension of the value
  bool any = false;    ///< true for the number 0 without a unit and products with it, which fit every dimension

  /// Returns true if the two values may be added, because their dimensions agree.
  bool like(const Value& other) const;
};

Value of_dimension(double si, Dimension dimension);  ///< A value of this dimension, given in its SI unit.

std::string dimension_text(const Value& value);  ///< The dimension of a value as text, for messages.

/// The reason, as a clause, why a parameter may not have this name: it is a unit of length or angle, a function or pi,
/// or it is not a name at all. Empty if the name is allowed.
std::string why_no_parameter(std::string_view name);

/// The value of an expression. values: those of the parameters, in their order, SI. Throws InputError with line and
/// column if the text is not an expression, adds unlike values, or is not finite.
Value evaluate(const Expression& expression, std::span<const GeometryParameter> parameters,
               std::span<const double> values);

/// The SI value of an expression of the dimension `wanted`. Also throws InputError if the expression has another
/// dimension.
double evaluate(const Expression& expression, Dimension wanted, std::span<const GeometryParameter> parameters,
                std::span<const double> values);

/// The SI value of an expression of the quantity `wanted`. Also throws InputError if the expression has another
/// dimension.
double evaluate(const Expression& expression, const Physical& wanted, std::span<const GeometryParameter> parameters,
                std::span<const double> values);

}  // namespace poesy::file
