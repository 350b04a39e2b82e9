#pragma once

#include <optional>

#include "engine/kinds/kind.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/study/plan.h"

namespace poesy {

/// Runs a Monte Carlo study on a pool of threads; see run_sensitivity(). Memory does not grow with the number of
/// samples: a pose's samples are dropped once its quantiles are known, except those that MonteCarloCollector keeps for
/// a longer study. Of the analysis it uses conf_level, quantiles and limits.
std::optional<MonteCarloResult> run_monte_carlo(const Plan& plan, const Model& model, const Analysis& analysis,
                                                const RunOptions& options);

/// Runs and reports Monte Carlo studies: the effect of all errors together.
extern const Kind kMonteCarloKind;

/// How Monte Carlo results are stored and reported.
/// @{
extern const FileKind kMonteCarloFile;
extern const ReportKind kMonteCarloReport;
/// @}

}  // namespace poesy
