#pragma once

#include <optional>
#include <string>

#include "engine/base/units.h"
#include "engine/fits/preferred_numbers.h"
#include "engine/study/study_kind.h"

namespace poesy::allocation {

/// Tolerances that a workshop prefers: multiples of a step, or preferred numbers of ISO 3 in some unit.
struct Rounding {
  double unit;                                 ///< the step, or the unit of the series (1 mm, 1 deg or 1), SI
  std::optional<PreferredSeries> series = {};  ///< the series of preferred numbers; none: multiples of the step

  double down(double tolerance) const;  ///< The largest preferred tolerance that is not above this one; 0 if there is
                                        ///< none.
  double up(double tolerance) const;  ///< The smallest positive preferred tolerance that is not below this one. With a
                                      ///< series, the result for a tolerance of 0 is 0.
  bool operator==(const Rounding&) const = default;  ///< Whether both have the same preferred tolerances.
};

/// Reads "0.001 mm" or "R10" for a tolerance of this dimension. Throws InputError at the value if it is neither.
Rounding read_rounding(const StudyValue& value, Dimension dimension);

/// The preferred tolerances as a TOML value that reads back as the same Rounding.
std::string rounding_text(const Rounding& rounding, Dimension dimension);
/// The preferred tolerances in words: "R10" or "steps of 0.001 mm".
std::string rounding_words(const Rounding& rounding, Dimension dimension);

}  // namespace poesy::allocation
