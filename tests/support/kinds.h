#pragma once

#include "engine/kinds/coupling/options.h"
#include "engine/kinds/evaluate/options.h"
#include "engine/kinds/identification/options.h"
#include "engine/kinds/monte_carlo/options.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/sensitivity/options.h"

namespace poesy::test {

/// A kind of study, as a parameter of tests.
using KindOfStudy = const StudyKind*;

/// For studies of any kind: Monte Carlo studies take them.
inline void set_quantiles(Analysis& analysis, const std::vector<double>& quantiles) {
  if (analysis.kind == &kMonteCarloStudy) asked_of<MonteCarloOptions>(analysis).quantiles = quantiles;
}

}  // namespace poesy::test
