#pragma once

#include "engine/optimise/least_cost.h"
#include "engine/optimise/sized_problem.h"

namespace poesy {

/// The choice of processes at least cost, by branch and bound. A node is a range of each part's processes; its bound is
/// Lagrange's, and the relaxation is the least cost of mixed processes. The node with the lowest bound is expanded
/// next. A process is pruned where the bound with it is above the cost of the best known choice. `bound` and `use` of
/// the result are left to the caller. Precondition: some part has several processes.
LeastCost branch_and_bound(const AllocationProblem& problem, const SizedProblem& sized, const SearchOptions& options);

}  // namespace poesy
