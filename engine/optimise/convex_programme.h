#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/optimise/least_cost.h"
#include "engine/optimise/sized_problem.h"

/// The tolerances with the least cost if each part has one process. They solve a convex optimisation problem.
namespace poesy {

/// The solution of a convex optimisation problem and its proof of optimality.
struct ConvexSolution {
  Allocation allocation;  ///< the tolerances with the least cost
  /// Lower bound on the cost if each part is made by the one process that the problem states for it.
  double lower_bound = 0.0;
  /// [limits] multipliers that prove the lower bound, in cost per unit of room (ToleranceLimits::room).
  std::vector<double> multiplier;
};

/// Finds the tolerances with the least cost. sized: the problem with only one process for each part. working_set:
/// indices of the limits that are likely to be used up; the search for multipliers starts with them. None if the lowest
/// tolerances break a limit.
std::optional<ConvexSolution> solve_convex(const AllocationProblem& problem, const SizedProblem& sized,
                                           std::span<const std::size_t> working_set);

/// [limits] The multipliers of all limits, in cost per unit of room (ToleranceLimits::room). multipliers:
/// [working set] multipliers of the limits as SizedProblem states them: each limit divided by its room. Limits outside
/// the working set, and limits with a negligible multiplier, get 0.
std::vector<double> limit_multipliers(const ToleranceLimits& limits, std::span<const std::size_t> working_set,
                                      std::span<const double> multipliers);

}  // namespace poesy
