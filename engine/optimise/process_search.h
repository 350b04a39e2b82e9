#pragma once

#include "engine/optimise/least_cost.h"
#include "engine/optimise/sized_problem.h"

namespace poesy {

/// The choice of processes at least cost, by branch and bound. Nodes are ranges of each part's menu; their bound is
/// Lagrange's, the best of which is the least cost of mixed processes. The node with the lowest bound is next, and a
/// process goes where the bound with it is above the cost of what is known. `bound` and `use` are left to the caller.
/// Precondition: some part has several processes.
LeastCost search_processes(const AllocationProblem& problem, const SizedProblem& sized, const SearchOptions& options);

}  // namespace poesy
