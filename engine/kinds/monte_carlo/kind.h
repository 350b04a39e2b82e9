#pragma once

#include <optional>

#include "engine/kinds/kind.h"
#include "engine/kinds/machine_calibration.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/study/plan.h"

namespace poesy::monte_carlo {

/// Runs a Monte Carlo study on a pool of threads. The result has the same bits for any number of threads, and also if
/// it continues from checkpoints. Memory hardly grows with the number of samples (see Collector and
/// MachineCollector). analysis: the analysis options of the plan's study. calibration: how the machines are calibrated;
/// null: they are not. Returns nothing if the run was stopped, and for a shard.
std::optional<Result> run_monte_carlo(const Plan& plan, const Model& model, const Analysis& analysis,
                                      const RunOptions& options, const MachineCalibration* calibration = nullptr);

/// Runs and reports Monte Carlo studies, in which all errors vary together.
extern const Kind kKind;

/// How Monte Carlo results are stored and reported.
/// @{
extern const FileKind kFile;
extern const ReportKind kReport;
/// @}

}  // namespace poesy::monte_carlo
