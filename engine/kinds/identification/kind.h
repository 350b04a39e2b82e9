#pragma once

#include "engine/kinds/kind.h"

namespace poesy::identification {

/// The kind of study `identification`: which errors deform the mechanism at all.
extern const Kind kKind;

/// How results of identification studies are stored and reported.
/// @{
extern const FileKind kFile;
extern const ReportKind kReport;
/// @}

}  // namespace poesy::identification
