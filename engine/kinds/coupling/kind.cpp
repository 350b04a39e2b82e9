#include "engine/kinds/coupling/kind.h"

#include "engine/kinds/coupling/options.h"
#include "engine/kinds/coupling/run.h"
#include "engine/kinds/coupling/stored.h"

namespace poesy {

constinit const Kind kCouplingKind{
    .study = kCouplingStudy, .run = kCouplingRun, .file = kCouplingFile, .report = kCouplingReport};

}  // namespace poesy
