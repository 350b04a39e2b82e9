#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// The kind of results that `poesy calibrate` writes. No study has this kind.
extern const Kind kCalibrationKind;

/// How results of calibrations are stored and reported.
/// @{
extern const FileKind kCalibrationFile;
extern const ReportKind kCalibrationReport;
/// @}

}  // namespace poesy
