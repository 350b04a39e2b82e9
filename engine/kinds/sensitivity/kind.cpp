#include "engine/kinds/sensitivity/kind.h"

#include "engine/kinds/sensitivity/options.h"
#include "engine/kinds/sensitivity/run.h"
#include "engine/kinds/sensitivity/set_tolerances.h"
#include "engine/kinds/sensitivity/stored.h"

namespace poesy {

constinit const Kind kSensitivityKind{.study = kSensitivityStudy,
                                      .run = kSensitivityRun,
                                      .file = kSensitivityFile,
                                      .report = kSensitivityReport,
                                      .set_tolerances = set_sensitivity_tolerances};

}  // namespace poesy
