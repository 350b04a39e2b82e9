#include "engine/app/duration.h"

#include <array>
#include <string_view>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/io/wording.h"

namespace poesy::app {

double parse_duration(const std::string& text, const std::string& option) {
  constexpr std::array<std::pair<std::string_view, double>, 3> kUnits{{{"min", 60.0}, {"s", 1.0}, {"h", 3600.0}}};
  for (const auto& [unit, seconds] : kUnits) {
    if (!text.ends_with(unit)) continue;
    std::string_view number(text);
    number.remove_suffix(unit.size());
    while (number.ends_with(' ')) number.remove_suffix(1);
    const auto value = parse_number(number);
    if (value && *value > 0.0) return *value * seconds;
  }
  throw InputError({}, option + " is '" + printable(text) + "'", "give a time with s, min or h, such as \"10 min\"");
}

}  // namespace poesy::app
