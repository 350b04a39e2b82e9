#pragma once

#include <optional>
#include <string>

#include "engine/base/units.h"
#include "engine/fits/preferred_numbers.h"
#include "engine/study/study_kind.h"

namespace poesy {

/// The tolerances that a workshop has: multiples of a step, or preferred numbers of a unit.
struct Rounding {
  double unit;                                 ///< the step, or what 1 of a series is: 1 mm or 1 deg (m or rad)
  std::optional<PreferredSeries> series = {};  ///< none: multiples

  double down(double tolerance) const;  ///< The largest of them that is not above the tolerance; 0 if there is none.
  double up(double tolerance) const;    ///< The smallest of them, above 0, that is not below; 0 for 0 of a series.
  bool operator==(const Rounding&) const = default;  ///< Same tolerances.
};

/// Reads "0.001 mm" or "R10", for tolerances of this dimension. Throws InputError at the value if it is neither.
Rounding read_rounding(const StudyValue& value, Dimension dimension);

std::string rounding_text(const Rounding& rounding, Dimension dimension);   ///< TOML that reads back to the same.
std::string rounding_words(const Rounding& rounding, Dimension dimension);  ///< "R10", "steps of 0.001 mm".

}  // namespace poesy
