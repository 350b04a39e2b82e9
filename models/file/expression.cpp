#include "models/file/expression.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/base/text.h"

namespace poesy::file {
namespace {

constexpr std::size_t kLongest = 1000;  ///< bytes; bounds the depth of the recursion, too
constexpr std::array<std::string_view, 5> kFunctions{"sqrt", "sin", "cos", "tan", "atan2"};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Null where it is no unit of length or angle. Others, such as h, are free for parameters.
const Unit* unit_of(std::string_view name) {
  const Unit* unit = find_unit(name);
  if (unit == nullptr || (unit->dimension != Dimension::length && unit->dimension != Dimension::angle)) return nullptr;
  return unit;
}

/// Reads from left to right; each function takes what its name says off the front.
class Parser {
 public:
  Parser(const Expression& expression, std::span<const GeometryParameter> parameters, std::span<const double> values)
      : expression_(expression), text_(expression.text), parameters_(parameters), values_(values) {}

  Value whole() {
    if (text_.size() > kLongest) fail(0, "is longer than 1000 bytes", "write it with fewer terms");
    const Value value = sum();
    skip();
    if (at_ < text_.size()) unexpected();
    if (!std::isfinite(value.si))
      fail(0, "is not finite", "look for a division by zero or the root of a negative number");
    return value;
  }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& problem, std::string_view remedy) const {
    Place place = expression_.place;
    if (place.column != 0 && expression_.quoted) place.column += 1 + at;
    throw InputError(place, expression_.key + " '" + printable(text_, 120) + "' " + problem, remedy);
  }

  [[noreturn]] void unexpected() {
    const bool ended = at_ >= text_.size();
    fail(at_, ended ? "ends too early" : "cannot be read at '" + printable(text_.substr(at_), 20) + "'",
         "write numbers with units, parameters, + - * / ( ), sqrt, sin, cos, tan, atan2 and pi, e.g. \"a + 20 mm\"");
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

  /// Throws at the operator where two values cannot be added.
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
      const int sign = times ? 1 : -1;
      value = {times ? value.si * next.si : value.si / next.si, value.length + sign * next.length,
               value.angle + sign * next.angle, value.any || (times && next.any)};
    }
  }

  Value factor() {
    if (take('+')) return factor();
    if (take('-')) {
      Value value = factor();
      value.si = -value.si;
      return value;
    }
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
    if (at_ >= text_.size() || !is_letter(text_[at_])) return {value, 0, 0, value == 0.0};
    const std::size_t at = at_;
    const std::string_view unit_name = word();
    const Unit* unit = unit_of(unit_name);
    if (unit == nullptr) {
      fail(at, "has an unknown unit '" + std::string(unit_name) + "'",
           "known: " + unit_names(Dimension::length) + ", " + unit_names(Dimension::angle) + "; write * to multiply");
    }
    return of_dimension(value * unit->si, unit->dimension);
  }

  Value named() {
    const std::size_t at = at_;
    const std::string_view name = word();
    if (name == "pi") return {std::numbers::pi};
    if (std::ranges::find(kFunctions, name) != kFunctions.end()) return function(name, at);
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      if (parameters_[p].name == name) return of_dimension(values_[p], parameters_[p].dimension);
    }
    std::vector<std::string_view> known;
    for (const GeometryParameter& parameter : parameters_) known.push_back(parameter.name);
    known.insert(known.end(), kFunctions.begin(), kFunctions.end());
    known.push_back("pi");
    fail(at, "has an unknown parameter '" + printable(name) + "'",
         parameters_.empty() ? "values in [geometry] are numbers; write the expression where it is used"
                             : suggestion(name, known));
  }

  Value function(std::string_view name, std::size_t at) {
    need('(');
    const Value x = sum();
    if (name == "atan2") {
      need(',');
      const Value y = sum();
      need(')');
      need_like(x, y, at, "takes atan2 of");
      return {std::atan2(x.si, y.si), 0, 1};
    }
    need(')');
    if (name == "sqrt") {
      if (x.length % 2 != 0 || x.angle % 2 != 0) {
        fail(at, "takes the root of " + dimension_text(x), "the root of a square has a meaning: sqrt(a * a)");
      }
      return {std::sqrt(x.si), x.length / 2, x.angle / 2, x.any};
    }
    if (x.length != 0 || (x.angle != 0 && x.angle != 1)) {
      fail(at, "takes " + std::string(name) + " of " + dimension_text(x), "give it an angle, e.g. 30 deg");
    }
    return {name == "sin" ? std::sin(x.si) : name == "cos" ? std::cos(x.si) : std::tan(x.si)};
  }

  const Expression& expression_;
  std::string_view text_;
  std::span<const GeometryParameter> parameters_;
  std::span<const double> values_;
  std::size_t at_ = 0;
};

}  // namespace

Value of_dimension(double si, Dimension dimension) {
  return {si, dimension == Dimension::length ? 1 : 0, dimension == Dimension::angle ? 1 : 0};
}

bool Value::like(const Value& other) const {
  return any || other.any || (length == other.length && angle == other.angle);
}

std::string dimension_text(const Value& value) {
  if (value.length == 0 && value.angle == 0) return "a number";
  if (value.length == 1 && value.angle == 0) return "a length";
  if (value.length == 0 && value.angle == 1) return "an angle";
  const auto power = [](const char* name, int exponent) {
    return exponent == 0 ? "" : exponent == 1 ? std::string(name) : name + ("^" + std::to_string(exponent));
  };
  const std::string length = power("length", value.length);
  const std::string angle = power("angle", value.angle);
  return length + (length.empty() || angle.empty() ? "" : " ") + angle;
}

std::string why_no_parameter(std::string_view name) {
  const auto allowed = [](char c) { return (is_letter(c) && static_cast<unsigned char>(c) < 0x80) || is_digit(c); };
  if (name.empty() || is_digit(name.front()) || !std::ranges::all_of(name, allowed)) {
    return "is no name: letters, digits and _, and no digit first";
  }
  if (unit_of(name) != nullptr) return "is a unit";
  if (name == "pi" || std::ranges::find(kFunctions, name) != kFunctions.end()) return "has a meaning in expressions";
  return {};
}

Value evaluate(const Expression& expression, std::span<const GeometryParameter> parameters,
               std::span<const double> values) {
  return Parser(expression, parameters, values).whole();
}

double evaluate(const Expression& expression, Dimension wanted, std::span<const GeometryParameter> parameters,
                std::span<const double> values) {
  const Value value = evaluate(expression, parameters, values);
  const Value due = of_dimension(0.0, wanted);
  if (value.like(due)) return value.si;
  const bool bare = value.length == 0 && value.angle == 0 && wanted != Dimension::number;
  throw InputError(expression.place,
                   expression.key + " '" + printable(expression.text, 120) + "' is " + dimension_text(value) +
                       ", but must be " + dimension_text(due),
                   bare ? "give it a unit, e.g. \"1 " + std::string(display_unit(wanted).name) + "\""
                        : "correct the expression or its unit");
}

}  // namespace poesy::file
