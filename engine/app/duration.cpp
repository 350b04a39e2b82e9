#include "engine/app/duration.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/base/units.h"

namespace poesy::app {
namespace {

/// "2 h 10 min"; without the smaller part where that is zero.
std::string two_parts(double count, double per_large, const char* large, const char* small) {
  const double whole = std::floor(count / per_large);
  const double rest = count - whole * per_large;
  return rest > 0.0 ? fmt::format("{:.0f} {} {:.0f} {}", whole, large, rest, small)
                    : fmt::format("{:.0f} {}", whole, large);
}

}  // namespace

double parse_duration(const std::string& text, const std::string& option) {
  constexpr std::string_view kRemedy = "give a time greater than zero with s, min or h, such as \"10 min\"";
  try {
    const Quantity quantity = parse_quantity(text);
    if (quantity.dimension == Dimension::time && quantity.si > 0.0) return quantity.si;
  } catch (const QuantityError&) {
    // The same answer for all that is no time.
  }
  throw InputError({}, option + " is '" + printable(text) + "'", kRemedy);
}

std::string readable_duration(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.2g} s", seconds);
  if (seconds < 59.5) return fmt::format("{:.0f} s", seconds);
  const double tens = std::round(seconds / 10.0) * 10.0;
  if (tens < 600.0) return two_parts(tens, 60.0, "min", "s");
  const double minutes = std::round(seconds / 60.0);
  if (minutes < 60.0) return fmt::format("{:.0f} min", minutes);
  if (minutes < 1440.0) return two_parts(minutes, 60.0, "h", "min");
  return two_parts(std::round(seconds / 3600.0), 24.0, "d", "h");
}

}  // namespace poesy::app
