#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Reads and writes what is special to results of studies that find tolerances under limits.
/// @{
extern const FileKind kAllocationFile;
extern const ReportKind kAllocationReport;
/// @}

/// Runs and reports studies that find tolerances under limits.
extern const Kind kAllocationKind;

}  // namespace poesy
