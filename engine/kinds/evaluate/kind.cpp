#include "engine/kinds/evaluate/kind.h"

#include "engine/kinds/evaluate/options.h"
#include "engine/kinds/evaluate/run.h"
#include "engine/kinds/evaluate/stored.h"

namespace poesy {

constinit const Kind kEvaluateKind{.study = kEvaluateStudy,
                                   .run = kCasesRun,
                                   .file = kEvaluationFile,
                                   .report = kEvaluationReport,
                                   .given_errors = evaluated_errors};

}  // namespace poesy
