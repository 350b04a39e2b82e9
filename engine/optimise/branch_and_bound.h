#pragma once

#include <optional>

#include "engine/optimise/least_cost.h"
#include "engine/optimise/sized_problem.h"

namespace poesy {

/// Finds the choice of processes at least cost by branch and bound. A node is a range of each part's processes. Its
/// bound is Lagrange's, and its relaxation is the least cost of mixed processes. The node with the lowest bound is
/// expanded next. A process is pruned if the bound with it is above the cost of the best known choice. The caller sets
/// `bound` and `use` of the result. None if no choice keeps the limits, which only pairs can cause. Precondition: some
/// part has several processes.
std::optional<LeastCost> branch_and_bound(const AllocationProblem& problem, const SizedProblem& sized,
                                          const SearchOptions& options);

}  // namespace poesy
