#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// The kind of study `coupling`: the effects of error sources of fixed size, alone and together.
extern const Kind kCouplingKind;

/// How results of coupling studies are stored and reported.
/// @{
extern const FileKind kCouplingFile;
extern const ReportKind kCouplingReport;
/// @}

}  // namespace poesy
