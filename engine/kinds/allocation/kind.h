#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// How results of studies that find tolerances under limits are stored and reported.
/// @{
extern const FileKind kAllocationFile;
extern const ReportKind kAllocationReport;
/// @}

/// Runs and reports studies that find tolerances under limits.
extern const Kind kAllocationKind;

}  // namespace poesy
