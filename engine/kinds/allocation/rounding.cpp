#include "engine/kinds/allocation/rounding.h"

#include <cmath>

#include "engine/base/text.h"

namespace poesy::allocation {
namespace {

constexpr double kSameMultiple = 1e-12;  // a tolerance that differs from a multiple by less than this share counts as
                                         // the multiple

}  // namespace

double Rounding::down(double tolerance) const {
  if (!(tolerance > 0.0)) return 0.0;
  if (series) return preferred_at_most(tolerance / unit, *series) * unit;
  return std::floor(tolerance / unit * (1.0 + kSameMultiple)) * unit;
}

double Rounding::up(double tolerance) const {
  if (!series) return std::fmax(1.0, std::ceil(tolerance / unit * (1.0 - kSameMultiple))) * unit;
  return tolerance > 0.0 ? preferred_at_least(tolerance / unit, *series) * unit : 0.0;
}

Rounding read_rounding(const StudyValue& value, Dimension dimension) {
  if (value.is_text()) {
    const std::string text = value.text();
    if (const auto series = find_preferred_series(text)) return {display_unit(dimension).si, *series};
    if (text.starts_with('R')) {
      value.fail("is '" + printable(text) + "'", "write R5, R10 or R20 of ISO 3, or a step, e.g. \"0.001 mm\"");
    }
  }
  return {value.positive_quantity(dimension)};
}

std::string rounding_text(const Rounding& rounding, Dimension dimension) {
  return rounding.series ? in_quotes(name(*rounding.series)) : exact_value(rounding.unit, dimension);
}

std::string rounding_words(const Rounding& rounding, Dimension dimension) {
  return rounding.series ? std::string(name(*rounding.series))
                         : "steps of " + readable_text({rounding.unit, dimension});
}

}  // namespace poesy::allocation
