#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/run_options.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

/// A factor on an error.
struct ErrorFactor {
  std::size_t error;  ///< position among the plan's factors
  double factor;      ///< finite; a negative one mirrors the error
};

/// Factors on some errors: a changed tolerance, or mirrored errors.
using Variation = std::vector<ErrorFactor>;

/// The loads (MachineLoads) [V x n] of the listed machines with each variation alone. machines: ascending numbers below
/// plan.samples(). A machine is solved at the poses that decide, where its load is within kDeciding of its largest. If
/// a variation changes a load there by more than half of that, in any of about forty machines, other poses may decide,
/// and these machines are solved at all poses. The result has the same bits for any number of threads and on all ranks.
/// Empty when stopped. Precondition: Draws::per_machine.
std::optional<std::vector<double>> try_variations(const Plan& plan, const Model& model,
                                                  std::span<const ResponseLimit> limits,
                                                  std::span<const std::uint32_t> machines,
                                                  std::span<const Variation> variations, const RunOptions& options);

/// Loads at a pose that are this near to the largest one decide; the limit is 1.
inline constexpr double kDeciding = 0.1;

}  // namespace poesy
