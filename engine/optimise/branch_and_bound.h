#pragma once

#include <optional>

#include "engine/optimise/least_cost.h"
#include "engine/optimise/sized_problem.h"

namespace poesy {

/// Finds the choice of processes with the least cost by branch and bound. A node allows a range of processes for each
/// part. The relaxation of a node is its problem if processes may be mixed (BestResponse); Lagrange's lower bound of
/// the relaxation is the bound of the node. The node with the lowest bound is expanded next. A process is pruned if the
/// lower bound with it exceeds the cost of the worst choice that the result must contain. The caller sets `bound` and
/// `use` of the result. Returns none if no choice keeps the limits, which can happen only with pairs. Precondition: at
/// least one part has several processes.
std::optional<LeastCost> branch_and_bound(const AllocationProblem& problem, const SizedProblem& sized,
                                          const SearchOptions& options);

}  // namespace poesy
