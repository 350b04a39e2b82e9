#pragma once

#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/identification/identification.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/sensitivity/result.h"

namespace poesy::test {

/// A kind of study, as a parameter of tests.
using KindOfStudy = const StudyKind*;

/// Sets the quantiles of a Monte Carlo study. Does nothing for other kinds.
inline void set_quantiles(Analysis& analysis, const std::vector<double>& quantiles) {
  if (analysis.kind == &monte_carlo::kStudy) asked_of<monte_carlo::Options>(analysis).quantiles = quantiles;
}

}  // namespace poesy::test
