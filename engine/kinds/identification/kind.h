#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// The kind of study `identification`: which errors deform the mechanism at all.
extern const Kind kIdentificationKind;

/// How results of identification studies are stored and reported.
/// @{
extern const FileKind kIdentificationFile;
extern const ReportKind kIdentificationReport;
/// @}

}  // namespace poesy
