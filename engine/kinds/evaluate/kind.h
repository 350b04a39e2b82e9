#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Named cases: what fixed errors do.
extern const Kind kEvaluateKind;

/// How result files and reports know them.
/// @{
extern const FileKind kEvaluationFile;
extern const ReportKind kEvaluationReport;
/// @}

}  // namespace poesy
