#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/optimise/least_cost.h"
#include "engine/optimise/sized_problem.h"

/// The tolerances at least cost if every part has one process: a convex programme.
namespace poesy {

/// The solution of a convex programme and its proof.
struct ConvexSolution {
  Allocation allocation;           ///< the tolerances at least cost
  double lower_bound = 0.0;        ///< lower bound on the cost with these processes
  std::vector<double> multiplier;  ///< [L] multipliers from which the bound follows
};

/// Solves the problem. sized: has one process of each part. working_set: limits that are likely to bind; the search for
/// multipliers starts with these. None if the lowest bounds break a limit.
std::optional<ConvexSolution> solve_convex(const AllocationProblem& problem, const SizedProblem& sized,
                                           std::span<const std::size_t> working_set);

/// [L] The multipliers of all limits, per unit of room, from those of a working set in SizedProblem's units. Negligible
/// ones are set to 0.
std::vector<double> limit_multipliers(const ToleranceLimits& limits, std::span<const std::size_t> working_set,
                                      std::span<const double> multipliers);

}  // namespace poesy
