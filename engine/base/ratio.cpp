#include "engine/base/ratio.h"

#include <string>

#include "engine/base/text.h"
#include "engine/base/units.h"

namespace poesy {

std::optional<double> ratio_unit(std::string_view spelling) {
  if (spelling == "%") return 1e-2;
  if (spelling == "ppm") return 1e-6;
  const std::size_t slash = spelling.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const Unit* part = find_unit(trimmed(spelling.substr(0, slash)));
  const Unit* whole = find_unit(trimmed(spelling.substr(slash + 1)));
  if (part == nullptr || whole == nullptr || part->dimension != whole->dimension) return std::nullopt;
  return part->si / whole->si;
}

std::optional<double> parse_ratio(std::string_view text) {
  const std::string_view body = trimmed(text);
  const std::size_t end = body.find_last_of("0123456789.");
  if (end == std::string_view::npos) return std::nullopt;
  const std::string number(trimmed(body.substr(0, end + 1)));
  const std::string_view unit = trimmed(body.substr(end + 1));
  // The factor is written as an exponent, because a multiplication would round: 0.1 % is the double nearest to 0.001.
  if (unit == "%") return parse_number(number + "e-2");
  if (unit == "ppm") return parse_number(number + "e-6");
  const std::optional<double> value = parse_number(number);
  const std::optional<double> size = ratio_unit(unit);
  if (!value || !size) return std::nullopt;
  return *value * *size;
}

}  // namespace poesy
