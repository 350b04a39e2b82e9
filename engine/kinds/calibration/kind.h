#pragma once

#include "engine/kinds/kind.h"

namespace poesy::calibration {

/// The kind of results that `poesy calibrate` writes. No study has this kind.
extern const Kind kKind;

/// How results of calibrations are stored and reported.
/// @{
extern const FileKind kFile;
extern const ReportKind kReport;
/// @}

}  // namespace poesy::calibration
