#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// The kind of study `evaluate`: the responses to named cases of fixed errors.
extern const Kind kEvaluateKind;

/// How results of evaluations are stored and reported.
/// @{
extern const FileKind kEvaluationFile;
extern const ReportKind kEvaluationReport;
/// @}

}  // namespace poesy
