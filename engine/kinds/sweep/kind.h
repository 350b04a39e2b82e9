#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// The kind of results that `poesy sweep` writes. No study has this kind.
extern const Kind kSweepKind;

/// How results of sweeps are stored and reported.
/// @{
extern const FileKind kSweepFile;
extern const ReportKind kSweepReport;
/// @}

}  // namespace poesy
