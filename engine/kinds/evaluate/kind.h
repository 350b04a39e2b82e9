#pragma once

#include "engine/kinds/kind.h"

namespace poesy {

/// Runs and reports studies of named cases: the responses to fixed errors.
extern const Kind kEvaluateKind;

/// Reads and writes what is special to results of evaluations.
/// @{
extern const FileKind kEvaluationFile;
extern const ReportKind kEvaluationReport;
/// @}

}  // namespace poesy
