#include "engine/kinds/identification/kind.h"

#include "engine/kinds/identification/run.h"
#include "engine/kinds/identification/stored.h"

namespace poesy {

constinit const Kind kIdentificationKind{.run = kIdentificationRun, .file = kIdentificationFile, .report = kIdentificationReport};

}  // namespace poesy
