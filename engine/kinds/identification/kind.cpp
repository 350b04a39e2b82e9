#include "engine/kinds/identification/kind.h"

#include "engine/kinds/identification/options.h"
#include "engine/kinds/identification/run.h"
#include "engine/kinds/identification/stored.h"

namespace poesy {

constinit const Kind kIdentificationKind{.study = kIdentificationStudy,
                                         .run = kIdentificationRun,
                                         .file = kIdentificationFile,
                                         .report = kIdentificationReport};

}  // namespace poesy
