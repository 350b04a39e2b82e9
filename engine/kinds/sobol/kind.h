#pragma once

#include "engine/kinds/kind.h"
#include "engine/kinds/sobol/result.h"

namespace poesy {

/// Studies of Sobol' indices: how the variance of each response divides among the errors and their interactions.
extern const Kind kSobolKind;

/// How result files and reports know them.
/// @{
extern const FileKind kSobolFile;
extern const ReportKind kSobolReport;
/// @}

}  // namespace poesy
