#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Runs and reports studies of named cases: the responses to fixed errors.
extern const Kind kEvaluateKind;

/// How results of evaluations are stored and reported.
/// @{
extern const FileKind kEvaluationFile;
extern const ReportKind kEvaluationReport;
/// @}

}  // namespace poesy
