#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Stores and reports results of `poesy calibrate`. No study has this kind.
extern const Kind kCalibrationKind;

/// How results of calibrations are stored and reported.
/// @{
extern const FileKind kCalibrationFile;
extern const ReportKind kCalibrationReport;
/// @}

}  // namespace poesy
