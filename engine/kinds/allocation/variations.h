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

/// Errors of these positions in a plan that are all times one factor: a tolerance that is changed, or errors that are
/// mirrored.
struct Variation {
  std::vector<std::size_t> errors;  ///< positions among the plan's factors
  double factor;                    ///< finite; below 0 errors are mirrored
};

/// Loads (Trial) [V x n] of the listed machines, ascending numbers below plan.samples(), with one variation after the
/// other. Each machine is tried at the poses that decide: those where its load is within kDeciding of its largest. A
/// variation that changes a load there by more than half of that, for one of some forty machines, may bring other
/// poses up: these machines are tried with it at all poses. On all ranks of a team, the same bits for any number of
/// threads. Empty when stopped. Precondition: Draws::per_machine.
std::optional<std::vector<double>> try_variations(const Plan& plan, const Model& model,
                                                  std::span<const ResponseLimit> limits,
                                                  std::span<const std::uint32_t> machines,
                                                  std::span<const Variation> variations, const RunOptions& options);

/// Of a load, the limit being 1.
inline constexpr double kDeciding = 0.1;

}  // namespace poesy
