#include "engine/app/duration.h"

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/io/wording.h"

namespace poesy::app {

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

}  // namespace poesy::app
