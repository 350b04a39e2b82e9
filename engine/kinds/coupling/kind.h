#pragma once

#include "engine/kinds/kind.h"

namespace poesy::coupling {

/// The kind of study `coupling`: the effects of error sources of fixed size, alone and together.
extern const Kind kKind;

/// How results of coupling studies are stored and reported.
/// @{
extern const FileKind kFile;
extern const ReportKind kReport;
/// @}

}  // namespace poesy::coupling
