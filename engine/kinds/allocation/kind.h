#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// How results of studies of kind `allocation` are stored and reported. Such a study finds the tolerances of parts
/// under limits.
/// @{
extern const FileKind kAllocationFile;
extern const ReportKind kAllocationReport;
/// @}

/// Runs studies of kind `allocation`, and describes their keys, result files and reports.
extern const Kind kAllocationKind;

}  // namespace poesy
