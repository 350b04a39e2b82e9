#include "engine/kinds/sweep/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/nan.h"
#include "engine/base/text.h"
#include "engine/base/units.h"

namespace poesy::sweep {
namespace {

constexpr const char* kForm = "write KEY=FROM:TO:STEP or KEY=A,B,C, e.g. geometry.R=250:300:10mm";

[[noreturn]] void refuse(const std::string& text, std::string_view problem, std::string_view remedy = kForm) {
  throw InputError({}, fmt::format("--set {} {}", printable(text), problem), remedy);
}

/// Divides a text at this character, except within brackets, braces and quotes.
std::vector<std::string> divided(std::string_view text, char sign) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    }
    if (c == sign && depth == 0 && quote == 0) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  for (std::string& part : parts) part = std::string(trimmed(part));
  return parts;
}

std::string with_unit_of(const SweptNumber& value) {
  // Twelve digits hide the rounding errors of FROM + k STEP (the k-th value of a range).
  std::string text = fmt::format("{:.12g}", value.number);
  return value.unit.empty() ? text : text + " " + value.unit;
}

/// The values FROM, FROM + STEP, ... up to TO. text: what the user wrote, for messages. ends: FROM, TO and STEP.
std::vector<std::string> range(const std::string& text, const std::vector<std::string>& ends) {
  constexpr double kSlack = 1e-9;  // a value may exceed TO by this share of a step, because of rounding
  if (ends.size() != 3) refuse(text, "is neither a list nor a range of three numbers");
  const SweptNumber step = number_of(ends[2]);
  std::vector<double> numbers;
  for (const std::string& end : ends) {
    const SweptNumber value = number_of(end);
    if (std::isnan(value.number)) refuse(text, fmt::format("has '{}' where a number is needed", printable(end)));
    if (!value.unit.empty() && value.unit != step.unit) {
      refuse(text, "mixes units", "write the unit once, after the step: 250:300:10mm");
    }
    numbers.push_back(value.number);
  }
  const double steps = std::floor((numbers[1] - numbers[0]) / numbers[2] + kSlack);
  if (!(steps >= 1.0 && std::isfinite(steps)))
    refuse(text, "makes no step from FROM to TO", "take a step of that sign, and at most that size");
  if (steps + 1.0 > static_cast<double>(kMostDesigns)) {
    refuse(text, fmt::format("asks for more than {} designs", kMostDesigns), "take a larger step");
  }
  std::vector<std::string> values;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(steps); ++k) {
    const double value = numbers[0] + static_cast<double>(k) * numbers[2];
    const bool is_zero = std::abs(value) < kSlack * std::abs(numbers[2]);
    values.push_back(with_unit_of({is_zero ? 0.0 : value, step.unit}));
  }
  return values;
}

/// The values of a list. The unit of the last value also applies to numbers before it that have no unit.
std::vector<std::string> list(const std::string& text, std::vector<std::string> values) {
  const std::string unit = number_of(values.back()).unit;
  for (std::string& value : values) {
    if (value.empty()) refuse(text, "has an empty value");
    const SweptNumber number = number_of(value);
    if (std::isnan(number.number) || unit.empty()) continue;
    if (number.unit.empty()) value += " " + unit;
    // Inserts a blank before the unit, so that "30um" is shown like "10 um".
    const std::size_t end = value.find(number.unit);
    if (!number.unit.empty() && end > 0 && value[end - 1] != ' ') value.insert(end, " ");
  }
  return values;
}

std::string full_name(const std::string& key) { return key.starts_with("geometry.") ? "mechanism." + key : key; }

}  // namespace

SweptNumber number_of(const std::string& value) {
  const std::string_view text = trimmed(value);
  const std::size_t end = std::min(text.find_first_not_of("0123456789+-.eE"), text.size());
  // Shortens the number at its end until it can be read: the letter in "1 e" or "2e" belongs to the unit and is not an
  // exponent.
  for (std::size_t length = end; length > 0; --length) {
    const std::optional<double> number = parse_number(trimmed(text.substr(0, length)));
    const std::string_view unit = trimmed(text.substr(length));
    if (number && (unit.empty() || unit == "%" || find_unit(unit) != nullptr)) return {*number, std::string(unit)};
  }
  return {kNaN, {}};
}

SweptKey parse_swept(const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0) refuse(text, "names no key and its values");
  const std::string written = text.substr(sign + 1);
  const std::vector<std::string> ends = divided(written, ':');
  SweptKey swept{full_name(std::string(trimmed(text.substr(0, sign)))),
                 ends.size() > 1 ? range(text, ends) : list(text, divided(written, ','))};
  if (swept.values.size() < 2) refuse(text, "has one value only, and a sweep compares several");
  for (std::size_t n = 0; n < swept.values.size(); ++n) {
    const auto before = swept.values.begin() + static_cast<std::ptrdiff_t>(n);
    if (std::find(swept.values.begin(), before, swept.values[n]) == before) continue;
    refuse(text, fmt::format("has {} twice", printable(swept.values[n])), "give each value once");
  }
  return swept;
}

std::vector<std::vector<GivenKey>> grid_of(std::span<const SweptKey> keys) {
  std::vector<std::vector<GivenKey>> designs(1);
  for (const SweptKey& swept : keys) {
    if (std::ranges::count(keys, swept.key, &SweptKey::key) > 1) {
      throw InputError({}, "--set names " + printable(swept.key) + " twice", "give all its values at once");
    }
    std::vector<std::vector<GivenKey>> more;
    for (const std::vector<GivenKey>& design : designs) {
      for (const std::string& value : swept.values) {
        more.push_back(design);
        more.back().push_back({swept.key, value});
      }
    }
    designs = std::move(more);
    if (designs.size() > kMostDesigns) {
      throw InputError({}, fmt::format("--set asks for more than {} designs", kMostDesigns), "take fewer values");
    }
  }
  return designs;
}

}  // namespace poesy::sweep
