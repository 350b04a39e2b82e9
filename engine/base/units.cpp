#include "engine/base/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace poesy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr std::array<Unit, 11> kUnits{{{"m", Dimension::length, 1.0},
                                       {"mm", Dimension::length, 1e-3},
                                       {"um", Dimension::length, 1e-6},
                                       {"rad", Dimension::angle, 1.0},
                                       {"mrad", Dimension::angle, 1e-3},
                                       {"deg", Dimension::angle, kDegree},
                                       {"arcsec", Dimension::angle, kDegree / 3600.0},
                                       {"s", Dimension::time, 1.0},
                                       {"ms", Dimension::time, 1e-3},
                                       {"min", Dimension::time, 60.0},
                                       {"h", Dimension::time, 3600.0}}};
constexpr Unit kOne{"1", Dimension::number, 1.0};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// std::from_chars takes no plus sign; one is allowed here, but not "+-1".
const char* after_plus(const char* begin, const char* end) {
  return end - begin > 1 && begin[0] == '+' && begin[1] != '-' ? begin + 1 : begin;
}

std::string known_units() {
  std::string list;
  for (const Unit& unit : kUnits) {
    if (!list.empty()) list += ", ";
    list += unit.name;
  }
  return list;
}

}  // namespace

std::span<const Unit> units() { return kUnits; }

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
      return kUnits[1];
    case Dimension::angle:
      return kUnits[5];
    case Dimension::time:
      return kUnits[7];
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

Quantity parse_quantity(std::string_view text) {
  const std::string_view body = trimmed(text);
  double number = 0.0;
  const char* begin = body.data();
  const char* end = begin + body.size();
  begin = after_plus(begin, end);
  const auto [after, failure] = std::from_chars(begin, end, number);
  if (failure != std::errc() || !std::isfinite(number)) {
    throw QuantityError("'" + std::string(text) + "' is not a finite number with a unit");
  }
  const std::string_view unit_name = trimmed(body.substr(static_cast<std::size_t>(after - body.data())));
  if (unit_name.empty()) {
    throw QuantityError("'" + std::string(text) + "' has no unit (known: " + known_units() + ")");
  }
  for (const Unit& unit : kUnits) {
    if (unit.name == unit_name) return {number * unit.si, unit.dimension};
  }
  throw QuantityError("unknown unit '" + std::string(unit_name) + "' in '" + std::string(text) +
                      "' (known: " + known_units() + ")");
}

std::optional<double> parse_number(std::string_view text) {
  const std::string_view body = trimmed(text);
  const char* begin = body.data();
  const char* end = begin + body.size();
  begin = after_plus(begin, end);
  double number = 0.0;
  const auto [after, failure] = std::from_chars(begin, end, number);
  if (failure != std::errc() || after != end || !std::isfinite(number)) return std::nullopt;
  return number;
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
