#pragma once

#include <chrono>
#include <cstdint>

#include "engine/run/result.h"

namespace poesy::app {

/// Facts about a run that started then and has just ended, on this machine.
RunFacts run_facts(std::chrono::steady_clock::time_point start, std::size_t threads, std::uint64_t solves);

}  // namespace poesy::app
