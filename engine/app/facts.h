#pragma once

#include <cstdint>

#include "engine/run/result.h"

namespace poesy::app {

/// Facts about a run that has just ended, on this machine.
RunFacts run_facts(double wall_seconds, std::size_t threads, std::uint64_t solves);

}  // namespace poesy::app
