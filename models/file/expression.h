#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/model/model.h"
#include "models/file/physical.h"

/// Numbers, parameters of the geometry, + - * / ^ ( ), sqrt, sin, cos, tan, atan2, pi, and a unit behind a number: "a +
/// 20 mm", "pi * d^4 / 64", "20 N/um". Dimensions are found together with values, so that an error names the place
/// inside the expression.
///
/// A name behind a number, without an operator, is a unit: "2 g" is two grams even where a parameter is called g, and
/// "2 * g" is twice the parameter. Hence a parameter may have the name of a unit, other than those of length and angle.
/// A unit is written without blanks around / and ^, and its power belongs to it: "2 m/s^2" is an acceleration, "2 m /
/// s^2" divides by a parameter; "5 mm^2" is five square millimetres, "(5 mm)^2" is 25. An exponent is a whole number;
/// -a^2 is -(a^2).
///
/// The parser is ours, because muparser (Debian) computes with doubles alone. Evaluating twice with other units of
/// length and angle does not see the dimension of what is zero ("offset + 1 deg" with offset = 0 mm). Its operators can
/// be replaced by those of encoded dimensions, but that is as long as this parser and knows no place of a mistake.
namespace poesy::file {

/// A quantity as a mechanism file has it: not yet a number, because a study may change the geometry.
struct Expression {
  std::string text;     ///< "a + 20 mm"
  std::string key;      ///< for messages: "limb[0].joints[1].at[2]"
  Place place;          ///< of the value
  bool quoted = false;  ///< then its text begins a column behind the place
};

/// A value with its dimension.
struct Value {
  double si = 0.0;     ///< in m, rad, kg, s and their powers
  Powers powers = {};  ///< of what it is a value
  bool any = false;    ///< the bare number 0, which is any quantity

  /// Whether they may be added.
  bool like(const Value& other) const;
};

Value of_dimension(double si, Dimension dimension);  ///< A value in the SI unit of a dimension.

std::string dimension_text(const Value& value);  ///< That of its powers.

/// Whether a name of a parameter would be taken for something else: a unit of length or angle, a function, pi. Or is no
/// name at all. A clause; empty where it may be used.
std::string why_no_parameter(std::string_view name);

/// The expression's value with these parameters, whose values are `values`, in that order.
/// Throws InputError with line and column where it is no expression, adds what cannot be added, or is not finite.
Value evaluate(const Expression& expression, std::span<const GeometryParameter> parameters,
               std::span<const double> values);

/// The same, of this dimension, SI: a length, an angle or a number. Throws InputError also for any other.
double evaluate(const Expression& expression, Dimension wanted, std::span<const GeometryParameter> parameters,
                std::span<const double> values);

/// The same, of this quantity, SI.
double evaluate(const Expression& expression, const Physical& wanted, std::span<const GeometryParameter> parameters,
                std::span<const double> values);

}  // namespace poesy::file
