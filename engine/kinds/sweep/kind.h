#pragma once

#include "engine/kinds/kind.h"

namespace poesy::sweep {

/// The kind of results that `poesy sweep` writes. No study has this kind.
extern const Kind kKind;

/// How results of sweeps are stored and reported.
/// @{
extern const FileKind kFile;
extern const ReportKind kReport;
/// @}

}  // namespace poesy::sweep
