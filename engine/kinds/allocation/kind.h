#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// The parts of the row for studies that find tolerances under limits.
/// @{
extern const FileKind kAllocationFile;
extern const ReportKind kAllocationReport;
/// @}

/// The kind itself.
extern const Kind kAllocationKind;

}  // namespace poesy
