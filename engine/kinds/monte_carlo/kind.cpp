#include "engine/kinds/monte_carlo/kind.h"

#include "engine/kinds/monte_carlo/options.h"
#include "engine/kinds/monte_carlo/run.h"
#include "engine/kinds/monte_carlo/stored.h"

namespace poesy {

constinit const Kind kMonteCarloKind{
    .study = kMonteCarloStudy, .run = kMonteCarloRun, .file = kMonteCarloFile, .report = kMonteCarloReport};

}  // namespace poesy
