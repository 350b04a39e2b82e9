#include "engine/base/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace poesy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr std::array<Unit, 13> kUnits{{{"m", Dimension::length, 1.0},
                                       {"cm", Dimension::length, 1e-2},
                                       {"mm", Dimension::length, 1e-3},
                                       {"um", Dimension::length, 1e-6},
                                       {"rad", Dimension::angle, 1.0},
                                       {"mrad", Dimension::angle, 1e-3},
                                       {"deg", Dimension::angle, kDegree},
                                       {"arcmin", Dimension::angle, kDegree / 60.0},
                                       {"arcsec", Dimension::angle, kDegree / 3600.0},
                                       {"s", Dimension::time, 1.0},
                                       {"ms", Dimension::time, 1e-3},
                                       {"min", Dimension::time, 60.0},
                                       {"h", Dimension::time, 3600.0}}};
constexpr Unit kOne{"1", Dimension::number, 1.0};

/// Another spelling of a unit, in UTF-8.
struct Spelling {
  std::string_view text;
  std::string_view unit;
};

constexpr std::array<Spelling, 3> kSpellings{{{"\xC2\xB5m", "um"}, {"\xCE\xBCm", "um"}, {"\xC2\xB0", "deg"}}};

constexpr const Unit* unit_named(std::string_view name) {
  for (const Unit& unit : kUnits) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// std::from_chars takes no plus sign; one is allowed here, but not "+-1".
const char* after_plus(const char* begin, const char* end) {
  return end - begin > 1 && begin[0] == '+' && begin[1] != '-' ? begin + 1 : begin;
}

/// A number at the beginning of a text.
struct NumberRead {
  double value = 0.0;
  std::errc failure{};    ///< none: there is a number, which may be infinite or not a number
  std::string_view rest;  ///< of the text, behind the number
};

NumberRead read_number(std::string_view text) {
  const char* end = text.data() + text.size();
  NumberRead read;
  const auto [after, failure] = std::from_chars(after_plus(text.data(), end), end, read.value);
  read.failure = failure;
  read.rest = text.substr(static_cast<std::size_t>(after - text.data()));
  return read;
}

/// Of a number that is out of range: whether it is too small, not too large.
bool is_too_small(std::string_view number) {
  const std::size_t exponent = number.find_first_of("eE");
  if (exponent != std::string_view::npos) return number.substr(exponent + 1).starts_with('-');
  return number.find_first_of("123456789") > number.find('.');
}

bool goes_on_behind_a_comma(std::string_view rest) {
  return rest.size() > 1 && rest[0] == ',' && rest[1] >= '0' && rest[1] <= '9';
}

/// Why there is no finite number at the beginning of a text; empty where there is one.
std::string problem_of(const NumberRead& read, std::string_view text) {
  if (read.failure == std::errc::result_out_of_range) {
    const std::string_view number = text.substr(0, text.size() - read.rest.size());
    return is_too_small(number) ? "is too small to be told from 0" : "is not a finite number, because it is too large";
  }
  if (read.failure != std::errc() || !std::isfinite(read.value)) return "is not a finite number";
  return goes_on_behind_a_comma(read.rest) ? "has a decimal comma; write a decimal point" : "";
}

}  // namespace

std::span<const Unit> units() { return kUnits; }

const Unit* find_unit(std::string_view spelling) {
  for (const Spelling& other : kSpellings) {
    if (other.text == spelling) return unit_named(other.unit);
  }
  return unit_named(spelling);
}

std::string unit_names(std::optional<Dimension> dimension) {
  std::string list;
  for (const Unit& unit : kUnits) {
    if (dimension && unit.dimension != *dimension) continue;
    if (!list.empty()) list += ", ";
    list += unit.name;
  }
  return list;
}

std::string_view si_unit(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return "m";
    case Dimension::angle:
      return "rad";
    case Dimension::time:
      return "s";
    case Dimension::number:
      break;
  }
  return "1";
}

Dimension dimension_of(std::string_view si_name) {
  for (const Dimension dimension : {Dimension::length, Dimension::angle, Dimension::time}) {
    if (si_unit(dimension) == si_name) return dimension;
  }
  return Dimension::number;
}

std::string_view error_kind(Dimension dimension) { return dimension == Dimension::angle ? "angular" : "linear"; }

const Unit& display_unit(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return *unit_named("mm");
    case Dimension::angle:
      return *unit_named("deg");
    case Dimension::time:
      return *unit_named("s");
    case Dimension::number:
      break;
  }
  return kOne;
}

std::string_view name(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return "length";
    case Dimension::angle:
      return "angle";
    case Dimension::time:
      return "time";
    case Dimension::number:
      break;
  }
  return "number";
}

Quantity parse_quantity(std::string_view text, std::optional<Dimension> wanted) {
  const std::string_view body = trimmed(text);
  const NumberRead number = read_number(body);
  const std::string shown = "'" + std::string(text) + "'";
  if (const std::string problem = problem_of(number, body); !problem.empty())
    throw QuantityError(shown + " " + problem);
  const std::string known = " (known: " + unit_names(wanted) + ")";
  const std::string_view unit_name = trimmed(number.rest);
  if (unit_name.empty()) throw QuantityError(shown + " has no unit" + known);
  if (const Unit* unit = find_unit(unit_name)) return {number.value * unit->si, unit->dimension};
  throw QuantityError("unknown unit '" + std::string(unit_name) + "' in " + shown + known);
}

std::optional<double> parse_number(std::string_view text) {
  const std::string_view body = trimmed(text);
  const NumberRead number = read_number(body);
  if (number.failure != std::errc() || !number.rest.empty() || !std::isfinite(number.value)) return std::nullopt;
  return number.value;
}

std::string number_problem(std::string_view text) {
  const std::string_view body = trimmed(text);
  const std::string problem = problem_of(read_number(body), body);
  return problem.empty() ? "is not a finite number" : problem;
}

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto [end, failure] = std::to_chars(text.data(), text.data() + text.size(), value);
  return failure == std::errc() ? std::string(text.data(), end) : std::string("nan");
}

std::string to_text(Quantity quantity) {
  return shortest(quantity.si) + " " + std::string(si_unit(quantity.dimension));
}

std::string readable_text(Quantity quantity, int digits) {
  const Unit& unit = display_unit(quantity.dimension);
  std::array<char, 32> text{};
  const auto [end, failure] =
      std::to_chars(text.data(), text.data() + text.size(), quantity.si / unit.si, std::chars_format::general, digits);
  const std::string number = failure == std::errc() ? std::string(text.data(), end) : std::string("nan");
  return unit.dimension == Dimension::number ? number : number + " " + std::string(unit.name);
}

}  // namespace poesy
