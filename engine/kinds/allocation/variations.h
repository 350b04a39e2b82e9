#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/kinds/machine_calibration.h"
#include "engine/model/model.h"
#include "engine/run/run_options.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy::allocation {

/// An error and a factor by which its values are multiplied.
struct ErrorFactor {
  std::size_t error;  ///< position among the plan's factors
  double factor;      ///< the factor, finite; a negative factor mirrors the error
};

/// The factors by which some errors of a machine are multiplied, to change a tolerance or to mirror errors.
using Variation = std::vector<ErrorFactor>;

/// The loads (MachineLoads) [variations x machines] of the listed machines with each variation alone. machines:
/// ascending numbers below plan.samples(). With a variation, a machine is first solved only at the poses that
/// decide (kDeciding) without the variation. Machines are solved in groups of at most forty. If a variation changes the
/// load of a machine at these poses by more than half of kDeciding, other poses may decide, and the whole group is
/// solved with this variation at all poses. All machines are solved at all poses if they are calibrated, or if a limit
/// is judged from several poses together. Each variation has its own calibration, with the same noise and prior
/// knowledge. The result has the same bits for any number of threads and on all ranks. None if the run was stopped.
/// calibration: as for machine_loads(). Preconditions: the study draws errors per machine; no variation has an error
/// that machines draw anew at each pose, because such an error is in no part.
std::optional<std::vector<double>> try_variations(const Plan& plan, const Model& model,
                                                  std::span<const ResponseLimit> limits,
                                                  std::span<const std::uint32_t> machines,
                                                  std::span<const Variation> variations, const RunOptions& options,
                                                  const MachineCalibration* calibration = nullptr);

/// A pose decides for a machine if the machine's load there is at most this much below its largest load. A load of 1 is
/// at the limit.
inline constexpr double kDeciding = 0.1;

}  // namespace poesy::allocation
