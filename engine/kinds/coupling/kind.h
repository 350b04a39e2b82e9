#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Coupling: what sources of errors of fixed size do one by one and together.
extern const Kind kCouplingKind;

/// How result files and reports know them.
/// @{
extern const FileKind kCouplingFile;
extern const ReportKind kCouplingReport;
/// @}

}  // namespace poesy
