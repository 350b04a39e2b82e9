#pragma once

#include "engine/kinds/kind.h"
#include "engine/kinds/sobol/result.h"

namespace poesy {

/// The kind of study `sobol`, which divides the variance of each response among the errors and their interactions.
extern const Kind kSobolKind;

/// How results of Sobol' indices are stored and reported.
/// @{
extern const FileKind kSobolFile;
extern const ReportKind kSobolReport;
/// @}

}  // namespace poesy
