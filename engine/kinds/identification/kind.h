#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Runs and reports identification studies: which errors deform the mechanism at all.
extern const Kind kIdentificationKind;

/// Reads and writes what is special to results of identification studies.
/// @{
extern const FileKind kIdentificationFile;
extern const ReportKind kIdentificationReport;
/// @}

}  // namespace poesy
