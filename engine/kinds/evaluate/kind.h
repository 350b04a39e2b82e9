#pragma once

#include "engine/kinds/kind.h"

namespace poesy::evaluate {

/// The kind of study `evaluate`: the responses to named cases of fixed errors.
extern const Kind kKind;

/// How results of evaluations are stored and reported.
/// @{
extern const FileKind kFile;
extern const ReportKind kReport;
/// @}

}  // namespace poesy::evaluate
