#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Identification: which errors deform the mechanism at all.
extern const Kind kIdentificationKind;

/// How result files and reports know them.
/// @{
extern const FileKind kIdentificationFile;
extern const ReportKind kIdentificationReport;
/// @}

}  // namespace poesy
