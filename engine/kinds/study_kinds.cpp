#include "engine/kinds/study_kinds.h"

#include <array>

#include "engine/kinds/coupling/options.h"
#include "engine/kinds/evaluate/options.h"
#include "engine/kinds/identification/options.h"
#include "engine/kinds/monte_carlo/options.h"
#include "engine/kinds/sensitivity/options.h"

namespace poesy {
namespace {

/// The keys of [analysis] as the reference lists them; a key that is not among them comes last.
constexpr std::array<std::string_view, 19> kKeys{"kind",      "factors",   "samples",    "conf_level", "background",
                                                 "reference", "linearity", "quantiles",  "groups",     "pose_share",
                                                 "cases",     "limits",    "judge",      "share",      "linear",
                                                 "angular",   "limbs",     "components", "sources"};

}  // namespace

const StudyKinds& study_kinds() {
  static const StudyKinds kinds = study_kinds_of(
      {&kSensitivityStudy, &kIdentificationStudy, &kEvaluateStudy, &kMonteCarloStudy, &kCouplingStudy}, kKeys);
  return kinds;
}

}  // namespace poesy
