#pragma once

#include <optional>

#include "engine/kinds/kind.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/study/plan.h"

namespace poesy {

/// Runs a Monte Carlo study on a pool of threads: as run_sensitivity, and memory does not grow with the number of
/// samples either; a pose's samples are dropped once its quantiles are known, but for what MonteCarloCollector keeps
/// for a longer study. Of the analysis it takes conf_level, quantiles and limits.
std::optional<MonteCarloResult> run_monte_carlo(const Plan& plan, const Model& model, const Analysis& analysis,
                                                const RunOptions& options);

/// Monte Carlo studies: what all errors do together.
extern const Kind kMonteCarloKind;

/// How result files and reports know them.
/// @{
extern const FileKind kMonteCarloFile;
extern const ReportKind kMonteCarloReport;
/// @}

}  // namespace poesy
