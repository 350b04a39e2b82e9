#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// How results of studies of kind `allocation` are stored and reported. A study of this kind finds tolerances of parts
/// with which the wanted share of machines keeps all limits.
/// @{
extern const FileKind kAllocationFile;
extern const ReportKind kAllocationReport;
/// @}

/// Runs studies of kind `allocation`, and describes their keys, result files and reports.
extern const Kind kAllocationKind;

}  // namespace poesy
