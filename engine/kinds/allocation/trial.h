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

/// Machines that were tried at some tolerances. The load of a machine is its largest response over its limit, of all
/// limits (K) at all poses (M): it is good up to 1. A machine that is not solved at a pose has an infinite load.
struct Trial {
  std::vector<double> load;           ///< [n] in the order in which they were asked for
  std::vector<double> pose_load;      ///< [M] the largest load of any of them at the pose alone
  std::vector<SolveCounts> solves;    ///< [M] of them
  std::vector<FailedSamples> failed;  ///< [M] the first of them
  std::vector<std::uint64_t> beyond;  ///< [K] machines that break this limit, or are not solved, at a pose
  std::uint64_t unsolved = 0;         ///< machines that no solved pose rejects, and that are not solved at another

  std::uint64_t rejects() const;  ///< Machines with a load above 1.
};

/// Tries machines of a plan: all of them, or those of a list of ascending numbers below plan.samples(). Machine s has
/// the errors of sample s of a Monte Carlo study with draws per machine. On all ranks of a team, the same bits for any
/// number of threads. Empty when stopped. Precondition: Draws::per_machine.
/// @{
std::optional<Trial> try_machines(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                  const RunOptions& options);
std::optional<Trial> try_machines(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                  std::span<const std::uint32_t> machines, const RunOptions& options);
/// @}

}  // namespace poesy
