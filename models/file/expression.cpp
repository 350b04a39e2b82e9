#include "models/file/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "engine/base/text.h"
#include "engine/base/units.h"

namespace poesy::file {
namespace {

/// Largest number of bytes of an expression; it also limits the depth of recursion.
constexpr std::size_t kLongest = 1000;
constexpr int kLargestExponent = 12;  ///< largest exponent after ^
/// Largest power of m, rad, kg or s; it keeps powers of powers in the range of int.
constexpr int kLargestPower = 100;
constexpr std::array<std::string_view, 6> kFunctions{"sqrt", "sin", "cos", "tan", "atan", "atan2"};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns true if a name is a unit of length or angle. The names of other units, such as h and N, may be names of
/// parameters.
bool is_unit_of_geometry(std::string_view name) {
  const Unit* unit = find_unit(name);
  return unit != nullptr && (unit->dimension == Dimension::length || unit->dimension == Dimension::angle);
}

/// Returns true if the argument of a trigonometric function is a number as written, so that nobody can know whether it
/// is in degrees. Computed numbers, such as an arc over a radius, are radians.
bool is_angle_without_unit(std::string_view written, double value) {
  return value != 0.0 && parse_number(written).has_value();
}

/// A recursive descent parser. Each function reads the construct that it is named after, from character number `at_` of
/// the text on.
class Parser {
 public:
  /// due: the dimension (powers of units) that the value must have, for messages; all powers are 0 if it is not known.
  Parser(const Expression& expression, std::span<const GeometryParameter> parameters, std::span<const double> values,
         const Powers& due)
      : expression_(expression), text_(expression.text), parameters_(parameters), values_(values), due_(due) {}

  Value whole() {
    if (text_.size() > kLongest) fail(0, "is longer than 1000 bytes", "write it with fewer terms");
    const Value value = sum();
    skip();
    if (at_ < text_.size()) unexpected();
    if (!std::isfinite(value.si)) {
      fail(0, "is not finite" + changed_text(), "look for a division by zero or the root of a negative number");
    }
    return value;
  }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& problem, std::string_view remedy) const {
    Place place = expression_.place;
    if (place.column != 0 && expression_.quoted) place.column += 1 + at;
    throw InputError(place, expression_.key + " '" + printable(text_, 120) + "' " + problem, remedy);
  }

  /// Text for messages that lists the parameters whose values differ from the file's, because a study may have stated
  /// them in a wrong unit: " with R = 120000 mm (the file has 120 mm)". Empty if there are none.
  std::string changed_text() const {
    std::string text;
    for (std::size_t p = 0; p < std::min(parameters_.size(), values_.size()); ++p) {
      const GeometryParameter& own = parameters_[p];
      if (values_[p] == own.published) continue;
      text += (text.empty() ? " with " : ", ") + own.name + " = " + readable_text({values_[p], own.dimension}) +
              " (the file has " + readable_text({own.published, own.dimension}) + ")";
    }
    return text;
  }

  [[noreturn]] void unexpected() {
    const bool ended = at_ >= text_.size();
    fail(at_, ended ? "ends too early" : "cannot be read at '" + printable(text_.substr(at_), 20) + "'",
         "write numbers with units, parameters, + - * / ^ ( ), sqrt, sin, cos, tan, atan, atan2 and pi, "
         "e.g. \"a + 20 mm\"");
  }

  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }

  bool take(char wanted) {
    skip();
    if (at_ >= text_.size() || text_[at_] != wanted) return false;
    ++at_;
    return true;
  }

  void need(char wanted) {
    if (!take(wanted)) unexpected();
  }

  std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  /// Throws InputError with the place of the operator if the two values cannot be added.
  void need_like(const Value& one, const Value& other, std::size_t at, std::string_view done) const {
    if (one.like(other)) return;
    fail(at, std::string(done) + " " + dimension_text(one) + " and " + dimension_text(other),
         "both must have one dimension; a bare number other than 0 has none, so give it a unit");
  }

  Value sum() {
    Value value = product();
    for (;;) {
      skip();
      const std::size_t at = at_;
      const bool plus = take('+');
      if (!plus && !take('-')) return value;
      const Value next = product();
      need_like(value, next, at, plus ? "adds" : "subtracts");
      const double si = plus ? value.si + next.si : value.si - next.si;
      value = value.any ? next : value;
      value.si = si;
    }
  }

  Value product() {
    Value value = factor();
    for (;;) {
      const bool times = take('*');
      if (!times && !take('/')) return value;
      const Value next = factor();
      value = {times ? value.si * next.si : value.si / next.si, multiplied(value.powers, next.powers, times ? 1 : -1),
               value.any || (times && next.any)};
    }
  }

  /// The powers of the product `one` x `other`^exponent.
  static Powers multiplied(const Powers& one, const Powers& other, int exponent) {
    return {one.length + exponent * other.length, one.angle + exponent * other.angle, one.mass + exponent * other.mass,
            one.time + exponent * other.time};
  }

  Value factor() {
    if (take('+')) return factor();
    if (take('-')) {
      Value value = factor();
      value.si = -value.si;
      return value;
    }
    return power();
  }

  Value power() {
    const Value base = primary();
    skip();
    const std::size_t at = at_;
    if (!take('^')) return base;
    const int exponent = whole_exponent();
    Value value{1.0, multiplied({}, base.powers, exponent), base.any && exponent > 0};
    for (int n = 0; n < std::abs(exponent); ++n) value.si *= base.si;
    if (exponent < 0) value.si = 1.0 / value.si;
    for (const int one : {value.powers.length, value.powers.angle, value.powers.mass, value.powers.time}) {
      if (std::abs(one) > kLargestPower) fail(at, "has a dimension that nothing has", "write a smaller exponent");
    }
    return value;
  }

  int whole_exponent() {
    skip();
    const std::size_t at = at_;
    int exponent = 0;
    const auto [end, failure] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), exponent);
    at_ = static_cast<std::size_t>(end - text_.data());
    const bool goes_on = at_ < text_.size() && (text_[at_] == '.' || is_letter(text_[at_]));
    if (failure != std::errc() || goes_on || std::abs(exponent) > kLargestExponent) {
      fail(at, "has an exponent that is not a whole number from -12 to 12", "write e.g. d^4; a root is sqrt(x)");
    }
    return exponent;
  }

  Value primary() {
    if (take('(')) {
      const Value value = sum();
      need(')');
      return value;
    }
    skip();
    if (at_ >= text_.size()) unexpected();
    if (is_digit(text_[at_]) || text_[at_] == '.') return number();
    if (!is_letter(text_[at_])) unexpected();
    return named();
  }

  Value number() {
    const char* begin = text_.data() + at_;
    double value = 0.0;
    const auto [end, failure] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (failure == std::errc::result_out_of_range) {
      fail(at_, "has a number that is out of range", "write one between 1e-307 and 1e307, or 0");
    }
    if (failure != std::errc()) unexpected();
    at_ += static_cast<std::size_t>(end - begin);
    skip();
    if (at_ >= text_.size() || !is_letter(text_[at_])) return {value, {}, value == 0.0};
    const WrittenUnit found = unit();
    return {value * found.si, found.powers};
  }

  /// Reads a unit after a number. A power directly behind the unit is part of the unit.
  WrittenUnit unit() {
    const std::size_t at = at_;
    const auto found = unit_at_begin(text_.substr(at));
    if (found) {
      at_ += found->length;
    } else {
      word();
    }
    std::size_t end = at_;
    const bool raised = take('^');
    if (found && !raised) return *found;
    if (raised) {
      take('-');
      word();
      end = at_;
    }
    fail(at, "has an unknown unit '" + printable(text_.substr(at, end - at)) + "'",
         raised ? "write the power of a quantity as in (5 mm)^3"
                : "known: " + known_units(due_) + "; write * to multiply");
  }

  Value named() {
    const std::size_t at = at_;
    const std::string_view name = word();
    if (name == "pi") return {.si = std::numbers::pi};
    if (std::ranges::find(kFunctions, name) != kFunctions.end()) return function(name, at);
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      if (parameters_[p].name == name) return of_dimension(values_[p], parameters_[p].dimension);
    }
    std::vector<std::string_view> known;
    for (const GeometryParameter& parameter : parameters_) known.push_back(parameter.name);
    known.insert(known.end(), kFunctions.begin(), kFunctions.end());
    known.push_back("pi");
    const std::string_view in_degrees = name.ends_with('d') ? name.substr(0, name.size() - 1) : std::string_view();
    if (in_degrees == "sin" || in_degrees == "cos" || in_degrees == "tan") {
      fail(at, fmt::format("has an unknown function '{}'", name),
           fmt::format("write {} of a number with the unit deg", in_degrees));
    }
    fail(at, "has an unknown parameter '" + printable(name) + "'",
         parameters_.empty() ? "values in [geometry] are numbers; write the expression where it is used"
                             : suggestion(name, known));
  }

  Value function(std::string_view name, std::size_t at) {
    need('(');
    const std::size_t begin = at_;
    const Value x = sum();
    const std::string_view written = trimmed(text_.substr(begin, at_ - begin));
    if (name == "atan2") {
      need(',');
      const Value y = sum();
      need(')');
      need_like(x, y, at, "takes atan2 of");
      return of_dimension(std::atan2(x.si, y.si), Dimension::angle);
    }
    need(')');
    if (name == "sqrt") {
      const auto& [length, angle, mass, time] = x.powers;
      const bool odd_angle = angle % 2 != 0 && x.powers.only_angle();
      if (length % 2 != 0 || mass % 2 != 0 || time % 2 != 0 || odd_angle) {
        fail(at, "takes the root of " + dimension_text(x), "take the root of a square, for instance sqrt(a * a)");
      }
      return {std::sqrt(x.si), {length / 2, angle / 2, mass / 2, time / 2}, x.any};
    }
    if (name == "atan") {
      if (!x.powers.like(kNumber.powers)) {
        fail(at, "takes atan of " + dimension_text(x), "give it a number, e.g. a/b, or take atan2(a, b)");
      }
      return of_dimension(std::atan(x.si), Dimension::angle);
    }
    if (!x.powers.like(kNumber.powers) && !x.powers.like(kAngle.powers)) {
      fail(at, "takes " + std::string(name) + " of " + dimension_text(x), "give it an angle, e.g. 30 deg");
    }
    if (is_angle_without_unit(written, x.si)) {
      fail(at, fmt::format("takes {} of {} without a unit", name, written),
           fmt::format("write {0}({1} deg), or {0}({1} rad)", name, written));
    }
    return {.si = name == "sin" ? std::sin(x.si) : name == "cos" ? std::cos(x.si) : std::tan(x.si)};
  }

  const Expression& expression_;
  std::string_view text_;
  std::span<const GeometryParameter> parameters_;
  std::span<const double> values_;
  Powers due_;
  std::size_t at_ = 0;
};

}  // namespace

Value of_dimension(double si, Dimension dimension) { return {si, physical(dimension).powers}; }

bool Value::like(const Value& other) const { return any || other.any || powers.like(other.powers); }

std::string dimension_text(const Value& value) { return dimension_text(value.powers); }

std::string why_no_parameter(std::string_view name) {
  const auto allowed = [](char c) { return (is_letter(c) && static_cast<unsigned char>(c) < 0x80) || is_digit(c); };
  if (name.empty() || is_digit(name.front()) || !std::ranges::all_of(name, allowed)) {
    return "is not a name: letters, digits and _, and no digit first";
  }
  if (is_unit_of_geometry(name)) return "is a unit";
  if (name == "pi" || std::ranges::find(kFunctions, name) != kFunctions.end()) return "has a meaning in expressions";
  return {};
}

Value evaluate(const Expression& expression, std::span<const GeometryParameter> parameters,
               std::span<const double> values) {
  return Parser(expression, parameters, values, {}).whole();
}

double evaluate(const Expression& expression, Dimension wanted, std::span<const GeometryParameter> parameters,
                std::span<const double> values) {
  return evaluate(expression, physical(wanted), parameters, values);
}

double evaluate(const Expression& expression, const Physical& wanted, std::span<const GeometryParameter> parameters,
                std::span<const double> values) {
  const Value value = Parser(expression, parameters, values, wanted.powers).whole();
  if (value.like({.powers = wanted.powers})) return value.si;
  const std::string unit = wanted.unit.empty() ? "" : " (" + std::string(wanted.unit) + ")";
  const std::string example = "\"" + std::string(wanted.example) + "\"";
  const bool bare = value.powers == kNumber.powers;
  throw InputError(expression.place,
                   expression.key + " '" + printable(expression.text, 120) + "' is " + dimension_text(value) +
                       ", but must be " + std::string(wanted.name) + unit,
                   bare           ? "give it a unit, e.g. " + example
                   : unit.empty() ? "correct the expression or its unit"
                                  : "write it like " + example);
}

}  // namespace poesy::file
