#pragma once

#include <optional>

#include "engine/kinds/kind.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/result/fields.h"
#include "engine/study/plan.h"

namespace poesy {

/// Runs a sensitivity study at one fidelity on a pool of threads. Units are merged in plan order, so the result has the
/// same bits for any number of threads, and whether it was continued from checkpoints or not: also from those of a plan
/// with fewer samples. Memory does not grow with the number of samples. Empty when stopped, and of a shard.
std::optional<SensitivityResult> run_sensitivity(const Plan& plan, const Model& model, double conf_level,
                                                 const RunOptions& options);

/// Bytes of what a result of these lengths says of its responses and errors (/sensitivity), in memory and in a file
/// alike.
std::size_t sensitivity_bytes(const AxisLengths& lengths);

/// Sensitivity studies: the effect of each error on its own.
extern const Kind kSensitivityKind;

/// How result files and reports know them.
/// @{
extern const FileKind kSensitivityFile;
extern const ReportKind kSensitivityReport;
/// @}

}  // namespace poesy
