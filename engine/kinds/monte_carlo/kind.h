#pragma once

#include <optional>

#include "engine/kinds/kind.h"
#include "engine/kinds/machine_calibration.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/study/plan.h"

namespace poesy {

/// Runs a Monte Carlo study on a pool of threads; see run_sensitivity(). Memory does not grow with the number of
/// samples: the samples of a pose are dropped when its quantiles are computed, except the packed sketches that
/// MonteCarloCollector keeps so that the study can be continued with more samples. analysis: that of the plan's study.
/// calibration: that of the machines; null: machines are not calibrated.
std::optional<MonteCarloResult> run_monte_carlo(const Plan& plan, const Model& model, const Analysis& analysis,
                                                const RunOptions& options,
                                                const MachineCalibration* calibration = nullptr);

/// Runs and reports Monte Carlo studies, in which all errors vary together.
extern const Kind kMonteCarloKind;

/// How Monte Carlo results are stored and reported.
/// @{
extern const FileKind kMonteCarloFile;
extern const ReportKind kMonteCarloReport;
/// @}

}  // namespace poesy
