#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/array.h"
#include "engine/kinds/allocation/relative_limits.h"
#include "engine/kinds/machine_calibration.h"
#include "engine/model/model.h"
#include "engine/run/result.h"
#include "engine/run/run_options.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy::allocation {

/// A machine whose load is from 1 - kNearLimit to 1 + kNearLimit counts as near the limits.
inline constexpr double kNearLimit = 0.1;

/// The loads of machines at given tolerances. The load of a machine is the largest ratio of a response to its limit,
/// both measured from the centre of the limit (RelativeLimits::load()), over all limits and poses. A machine is good if
/// its load is at most 1. A machine that is not solved at a pose has an infinite load.
struct MachineLoads {
  std::vector<double> load;           ///< [machines] load of each machine, in the order of their numbers
  std::vector<SolveCounts> solves;    ///< [poses] how the solves at each pose ended
  std::vector<FailedSamples> failed;  ///< [poses] the first failed solves at each pose
  /// [limits] Number of machines that break the limit, or are not solved, at some pose.
  std::vector<std::uint64_t> beyond;
  /// Number of machines near the limits (kNearLimit) whose load is that of this limit at this pose. Machines whose load
  /// is that of a limit judged from several poses together (RelativeLimits::is_over_poses()) are counted at pose 0.
  Array<std::uint64_t, axis::Limit, axis::Pose> near;
  std::uint64_t unsolved = 0;  ///< number of machines that are rejected only because they were not solved at some pose
};

/// Solves machines of a plan: all of them, or those that are listed (ascending numbers below plan.samples()). Machine s
/// has the errors of sample s of a Monte Carlo study with draws per machine; if that study calibrates its machines, the
/// measurement noise of machine s is the same too. The result has the same bits for any number of threads and on all
/// ranks. None if the run was stopped. calibration: how the machines are calibrated; null: they are not. Precondition:
/// the study draws errors per machine.
/// @{
std::optional<MachineLoads> machine_loads(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                          const RunOptions& options, const MachineCalibration* calibration = nullptr);
std::optional<MachineLoads> machine_loads(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                          std::span<const std::uint32_t> machines, const RunOptions& options,
                                          const MachineCalibration* calibration = nullptr);
/// @}

}  // namespace poesy::allocation
