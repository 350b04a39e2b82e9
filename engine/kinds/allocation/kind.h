#pragma once

#include "engine/kinds/kind.h"

namespace poesy::allocation {

/// How results of studies of kind `allocation` are stored and reported. A study of this kind finds tolerances of parts
/// with which the wanted share of machines keeps all limits.
/// @{
extern const FileKind kFile;
extern const ReportKind kReport;
/// @}

/// Runs studies of kind `allocation`, and describes their keys, result files and reports.
extern const Kind kKind;

}  // namespace poesy::allocation
