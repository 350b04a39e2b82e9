#include "engine/fits/fit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/fits/it_grade.h"

namespace poesy {
namespace {

/// The largest nominal size that kSteps covers, mm.
constexpr double kLargest = 500.0;

/// How far the zones of shafts d to g are below the nominal size, for sizes up to and including `up_to`. (The zone of a
/// hole H begins at the nominal size, and that of a shaft h ends there.)
struct DistanceStep {
  double up_to;                      ///< largest nominal size, mm
  std::array<double, 4> micrometre;  ///< distances of the classes d, e, f, g, micrometres
};

/// Fundamental deviations of ISO 286-1:2010, Table 4, without their sign: all are negative.
constexpr std::array<DistanceStep, 13> kSteps{{{3, {20, 14, 6, 2}},
                                               {6, {30, 20, 10, 4}},
                                               {10, {40, 25, 13, 5}},
                                               {18, {50, 32, 16, 6}},
                                               {30, {65, 40, 20, 7}},
                                               {50, {80, 50, 25, 9}},
                                               {80, {100, 60, 30, 10}},
                                               {120, {120, 72, 36, 12}},
                                               {180, {145, 85, 43, 14}},
                                               {250, {170, 100, 50, 15}},
                                               {315, {190, 110, 56, 17}},
                                               {400, {210, 125, 62, 18}},
                                               {500, {230, 135, 68, 20}}}};

/// Throws std::invalid_argument with the text in quotes, followed by the problem.
[[noreturn]] void refuse(std::string_view text, const std::string& problem) {
  throw std::invalid_argument("'" + printable(text) + "' " + problem);
}

/// A nominal size and the text that follows it, such as "H7".
struct NominalSize {
  double metres;
  std::string_view zones;
};

NominalSize nominal_size(std::string_view text) {
  const std::string_view body = trimmed(text);
  double number = 0.0;
  const auto [end, failure] = std::from_chars(body.data(), body.data() + body.size(), number, std::chars_format::fixed);
  if (failure != std::errc() || !(number > 0.0)) refuse(text, "does not begin with a nominal size above zero");
  std::string_view rest = trimmed(body.substr(static_cast<std::size_t>(end - body.data())));
  double metres = number / 1e3;
  const std::string_view name = rest.substr(0, rest.find(' '));
  const bool is_unit = name.size() < rest.size() && name.find_first_of("0123456789") == std::string_view::npos;
  if (is_unit) {
    const Unit* const unit = find_unit(name);
    if (unit == nullptr || unit->dimension != Dimension::length) {
      refuse(text, "has '" + printable(name) + "' where a unit of length may be (" + unit_names(Dimension::length) +
                       "); without one the size is in mm");
    }
    metres = number * unit->si;
    rest = trimmed(rest.substr(name.size()));
  }
  constexpr double kRounding = 1.0 + 1e-12;
  if (metres * 1e3 > kLargest * kRounding) refuse(text, "is beyond 500 mm, the largest nominal size of this table");
  return {metres, rest};
}

/// The grade from the digits of a tolerance class: "01", "0", "1" to "18"; none for other texts.
std::optional<ItGrade> grade_of(std::string_view digits) {
  if (digits == "01") return ItGrade::it01;
  if (digits == "0") return ItGrade::it0;
  int number = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool whole = failure == std::errc() && end == digits.data() + digits.size() && digits.front() != '0';
  if (!whole || number < 1 || number > 18) return std::nullopt;
  return ItGrade{static_cast<int>(ItGrade::it1) + number - 1};
}

/// The distance from the nominal size down to the zone of a shaft, m. letter: d to h.
double distance_of(char letter, double metres) {
  if (letter == 'h') return 0.0;
  const double size = metres * 1e3 * (1.0 - 1e-12);  // a size converted to m may be above a step by rounding
  const auto step = std::ranges::find_if(kSteps, [&](const DistanceStep& one) { return size <= one.up_to; });
  return step->micrometre[static_cast<std::size_t>(letter - 'd')] / 1e6;
}

/// The limits of one tolerance class, such as "h6", for a nominal size in m. text: the user's whole text, for messages.
SizeLimits limits_of(std::string_view zone, double metres, std::string_view text) {
  const char letter = zone.empty() ? ' ' : zone.front();
  if (letter != 'H' && (letter < 'd' || letter > 'h')) {
    refuse(text, "has no zone of this table: it knows holes H and shafts d, e, f, g, h, such as H7 or g6");
  }
  const auto grade = grade_of(zone.substr(1));
  if (!grade) refuse(text, "has no grade from 01 to 18 after the letter " + std::string(1, letter));
  const auto width = it_grade_width(metres, *grade);
  if (!width) refuse(text, "has the grade " + it_grade_name(*grade) + ", which ISO 286-1 does not have for this size");
  if (letter == 'H') return {0.0, *width};
  const double upper = -distance_of(letter, metres);
  return {upper - *width, upper};
}

}  // namespace

SizeLimits size_limits(std::string_view text) {
  const NominalSize size = nominal_size(text);
  if (size.zones.find('/') != std::string_view::npos) {
    refuse(text, "is a fit of two parts; write the zone of one of them, such as H7 or g6");
  }
  return limits_of(size.zones, size.metres, text);
}

Fit fit(std::string_view text) {
  const NominalSize size = nominal_size(text);
  const std::size_t slash = size.zones.find('/');
  if (slash == std::string_view::npos) refuse(text, "is not a fit; write the zones of hole and shaft, such as 8 H7/g6");
  const std::string_view first = trimmed(size.zones.substr(0, slash));
  const std::string_view second = trimmed(size.zones.substr(slash + 1));
  const SizeLimits hole = limits_of(first, size.metres, text);
  const SizeLimits shaft = limits_of(second, size.metres, text);
  if (first.front() != 'H' || second.front() == 'H') refuse(text, "is not a hole H before a shaft d, e, f, g or h");
  const auto variance = [](const SizeLimits& zone) {
    const double sigma = (zone.upper - zone.lower) / 6.0;
    return sigma * sigma;
  };
  const double least = hole.lower - shaft.upper;
  const double most = hole.upper - shaft.lower;
  return {least, most, 0.5 * (least + most), variance(hole) + variance(shaft)};
}

}  // namespace poesy
