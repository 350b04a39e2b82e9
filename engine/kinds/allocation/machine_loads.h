#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/result.h"
#include "engine/run/run_options.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

/// The results of n machines at given tolerances. The load of a machine is the largest ratio of a response to its
/// limit, among all limits (K) at all poses (M), so a machine is good if its load is at most 1. A machine that is not
/// solved at a pose has an infinite load.
struct MachineLoads {
  std::vector<double> load;           ///< [n] in the order of their numbers
  std::vector<SolveCounts> solves;    ///< [M] how their solves ended
  std::vector<FailedSamples> failed;  ///< [M] the first solves that failed
  std::vector<std::uint64_t> beyond;  ///< [K] machines that break this limit, or are not solved, at a pose
  std::uint64_t unsolved = 0;         ///< machines that are rejected only because a pose was not solved
};

/// Solves machines of a plan: all of them, or those that are listed (ascending numbers below plan.samples()). Machine s
/// has the errors of sample s of a Monte Carlo study with draws per machine. The result has the same bits for any
/// number of threads and on all ranks. Empty when stopped. Precondition: Draws::per_machine.
/// @{
std::optional<MachineLoads> machine_loads(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                          const RunOptions& options);
std::optional<MachineLoads> machine_loads(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                          std::span<const std::uint32_t> machines, const RunOptions& options);
/// @}

}  // namespace poesy
