#pragma once

#include <optional>

#include "engine/kinds/kind.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/result/fields.h"
#include "engine/study/plan.h"

namespace poesy::sensitivity {

/// Runs a sensitivity study at one fidelity on a pool of threads. Units are merged in the order of the plan, so the
/// result has the same bits for any number of threads, and also if it continues from checkpoints, even from those of a
/// plan with fewer samples. Memory does not grow with the number of samples. Returns nothing if the run was stopped,
/// and for a shard.
std::optional<Result> run_sensitivity(const Plan& plan, const Model& model, double conf_level,
                                      const RunOptions& options);

/// The size in bytes of the numeric arrays of the group /sensitivity if their axes have these lengths. It is the same
/// in memory and in a file.
std::size_t sensitivity_bytes(const AxisLengths& lengths);

/// Runs and reports sensitivity studies, which compute the effect of each error while all others are constant.
extern const Kind kKind;

/// How sensitivity results are stored and reported.
/// @{
extern const FileKind kFile;
extern const ReportKind kReport;
/// @}

}  // namespace poesy::sensitivity
