#pragma once

#include "engine/kinds/kind.h"
#include "engine/kinds/sobol/result.h"

namespace poesy::sobol {

/// The kind of study `sobol`, which divides the variance of each response among the errors and their interactions.
extern const Kind kKind;

/// How results of Sobol' indices are stored and reported.
/// @{
extern const FileKind kFile;
extern const ReportKind kReport;
/// @}

}  // namespace poesy::sobol
