#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/optimise/least_cost.h"
#include "engine/optimise/sized_problem.h"

/// The tolerances at least cost where every part has one process.
namespace poesy {

/// What was found, and its proof.
struct ChosenAllocation {
  Allocation allocation;           ///< at least cost
  double lower_bound = 0.0;        ///< on the cost with these processes
  std::vector<double> multiplier;  ///< [L] from which the bound follows
  std::vector<std::size_t> rows;   ///< limits that took part in the search for prices
};

/// sized: the same problem with one process in each menu. rows: limits that are likely to matter. None where the lowest
/// bounds break a limit.
std::optional<ChosenAllocation> allocate_chosen(const AllocationProblem& problem, const SizedProblem& sized,
                                                std::span<const std::size_t> rows);

/// [L] multipliers from the prices of some limits. Those that are nothing beside the others are 0.
std::vector<double> multipliers(const ToleranceLimits& limits, std::span<const std::size_t> rows,
                                std::span<const double> prices);

}  // namespace poesy
