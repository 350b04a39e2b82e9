#include "engine/base/units.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "engine/base/text.h"

namespace poesy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr double kInch = 0.0254;

constexpr std::array<Unit, 24> kUnits{{{"m", Dimension::length, 1.0},
                                       {"cm", Dimension::length, 1e-2},
                                       {"mm", Dimension::length, 1e-3},
                                       {"um", Dimension::length, 1e-6},
                                       {"in", Dimension::length, kInch},
                                       {"mil", Dimension::length, 1e-3 * kInch},
                                       {"thou", Dimension::length, 1e-3 * kInch},
                                       {"rad", Dimension::angle, 1.0},
                                       {"mrad", Dimension::angle, 1e-3},
                                       {"deg", Dimension::angle, kDegree},
                                       {"arcmin", Dimension::angle, kDegree / 60.0},
                                       {"arcsec", Dimension::angle, kDegree / 3600.0},
                                       {"s", Dimension::time, 1.0},
                                       {"ms", Dimension::time, 1e-3},
                                       {"min", Dimension::time, 60.0},
                                       {"h", Dimension::time, 3600.0},
                                       {"N", Dimension::force, 1.0},
                                       {"kN", Dimension::force, 1e3},
                                       {"N m", Dimension::moment, 1.0},
                                       {"N mm", Dimension::moment, 1e-3},
                                       {"kN m", Dimension::moment, 1e3},
                                       {"J", Dimension::energy, 1.0},
                                       {"mJ", Dimension::energy, 1e-3},
                                       {"uJ", Dimension::energy, 1e-6}}};

constexpr std::array<Dimension, 7> kAll{Dimension::length, Dimension::angle,  Dimension::time,  Dimension::number,
                                        Dimension::force,  Dimension::moment, Dimension::energy};

/// The name of a dimension, its SI unit, and the unit in which reports show it. The table is in the order of Dimension.
struct DimensionWords {
  std::string_view name;
  std::string_view si_unit;
  Unit display;
};

constexpr std::array<DimensionWords, kAll.size()> kDimensions{{{"length", "m", {"mm", Dimension::length, 1e-3}},
                                                               {"angle", "rad", {"deg", Dimension::angle, kDegree}},
                                                               {"time", "s", {"s", Dimension::time, 1.0}},
                                                               {"number", "1", {"1", Dimension::number, 1.0}},
                                                               {"force", "N", {"N", Dimension::force, 1.0}},
                                                               {"moment", "N m", {"N m", Dimension::moment, 1.0}},
                                                               {"energy", "J", {"J", Dimension::energy, 1.0}}}};

const DimensionWords& words_of(Dimension dimension) { return kDimensions.at(static_cast<std::size_t>(dimension)); }

/// Another spelling of a unit, in UTF-8.
struct Spelling {
  std::string_view text;
  std::string_view unit;
};

constexpr std::array<Spelling, 6> kSpellings{{{"\xC2\xB5m", "um"},
                                              {"\xCE\xBCm", "um"},
                                              {"\xC2\xB0", "deg"},
                                              {"\xC2\xB5J", "uJ"},
                                              {"\xCE\xBCJ", "uJ"},
                                              {"inch", "in"}}};

/// The number as text in a format of std::to_chars.
template <class... Format>
std::string number_text(double value, Format... format) {
  std::array<char, 32> text{};
  const auto [end, failure] = std::to_chars(text.data(), text.data() + text.size(), value, format...);
  return failure == std::errc() ? std::string(text.data(), end) : std::string("nan");
}

/// A number at the beginning of a text.
struct NumberRead {
  double value = 0.0;
  std::errc failure{};    ///< std::errc() if a number was read, which may be infinite or NaN
  std::string_view rest;  ///< the text after the number
};

NumberRead read_number(std::string_view text) {
  // std::from_chars does not accept a plus sign, so it is skipped here; "+-1" stays invalid.
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  const char* end = text.data() + text.size();
  NumberRead read;
  const auto [after, failure] = std::from_chars(text.data() + (plus ? 1 : 0), end, read.value);
  read.failure = failure;
  read.rest = text.substr(static_cast<std::size_t>(after - text.data()));
  return read;
}

/// For a number outside the range of double: returns true if it is too close to 0, false if it is too large.
bool is_too_small(std::string_view number) {
  const std::size_t exponent = number.find_first_of("eE");
  if (exponent != std::string_view::npos) return number.substr(exponent + 1).starts_with('-');
  return number.find_first_of("123456789") > number.find('.');
}

/// The reason why the text does not begin with a finite number, or a remark that the number has a decimal comma; empty
/// if there is no such problem.
std::string problem_of(const NumberRead& read, std::string_view text) {
  if (read.failure == std::errc::result_out_of_range) {
    const std::string_view number = text.substr(0, text.size() - read.rest.size());
    return is_too_small(number) ? "is too small to be told from 0" : "is not a finite number, because it is too large";
  }
  if (read.failure != std::errc() || !std::isfinite(read.value)) return "is not a finite number";
  const bool comma = read.rest.size() > 1 && read.rest[0] == ',' && read.rest[1] >= '0' && read.rest[1] <= '9';
  return comma ? "has a decimal comma; write a decimal point" : "";
}

}  // namespace

std::span<const Dimension> all_dimensions() { return kAll; }

std::span<const Unit> units() { return kUnits; }

const Unit* find_unit(std::string_view spelling) {
  const auto other = std::ranges::find(kSpellings, spelling, &Spelling::text);
  const std::string_view name = other == kSpellings.end() ? spelling : other->unit;
  const auto unit = std::ranges::find(kUnits, name, &Unit::name);
  return unit == kUnits.end() ? nullptr : &*unit;
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

std::string_view name(Dimension dimension) { return words_of(dimension).name; }

std::string with_article(Dimension dimension) {
  const std::string word(name(dimension));
  return (std::string_view("aeiou").find(word.front()) == std::string_view::npos ? "a " : "an ") + word;
}

std::string_view si_unit(Dimension dimension) { return words_of(dimension).si_unit; }
const Unit& display_unit(Dimension dimension) { return words_of(dimension).display; }

Dimension dimension_of(std::string_view si_name) {
  const auto found = std::ranges::find(kDimensions, si_name, &DimensionWords::si_unit);
  return found == kDimensions.end() ? Dimension::number : found->display.dimension;
}

std::string_view error_kind(Dimension dimension) {
  if (dimension == Dimension::number) return "relative";
  return dimension == Dimension::angle ? "angular" : "linear";
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

std::string shortest(double value) { return number_text(value); }

std::string to_text(Quantity quantity) {
  return shortest(quantity.si) + " " + std::string(si_unit(quantity.dimension));
}

std::string readable_text(Quantity quantity, int digits) {
  const Unit& unit = display_unit(quantity.dimension);
  const std::string number = number_text(quantity.si / unit.si, std::chars_format::general, digits);
  return unit.dimension == Dimension::number ? number : number + " " + std::string(unit.name);
}

}  // namespace poesy
