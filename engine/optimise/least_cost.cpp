#include "engine/optimise/least_cost.h"

#include <algorithm>
#include <optional>

#include "engine/base/contract.h"
#include "engine/optimise/branch_and_bound.h"
#include "engine/optimise/convex_programme.h"
#include "engine/optimise/sized_problem.h"

namespace poesy {
namespace {

AtBound bound_of(const Process& process, double tolerance) {
  if (process.lo == process.hi) return AtBound::single;
  if (tolerance == process.lo) return AtBound::lower;
  return tolerance == process.hi ? AtBound::upper : AtBound::none;
}

/// Sets the members of the result that follow from its tolerances: `bound` and `use`.
void complete(const AllocationProblem& problem, LeastCost& found) {
  for (std::size_t i = 0; i < problem.parts.size(); ++i) {
    found.bound.push_back(bound_of(problem.parts[i][found.best.process[i]], found.best.tolerance[i]));
  }
  for (const std::size_t part : found.best.left_out) found.bound[part] = AtBound::none;
  if (problem.limits.count() > 0) found.use = worst_use(problem.limits, found.best.tolerance);
}

std::optional<LeastCost> without_choice(const AllocationProblem& problem, const SizedProblem& sized) {
  const auto found = solve_convex(problem, sized, {});
  if (!found) return std::nullopt;
  return LeastCost{found->allocation, found->lower_bound, {}, found->multiplier, found->multiplier, {0, 0.0}, {}};
}

/// The result for a problem with pairs that is infeasible although each limit alone can be kept. Without pairs this
/// cannot happen, because the smallest tolerances would keep all limits.
Infeasible together(const AllocationProblem& problem) {
  POESY_EXPECTS(!problem.pairs.empty());
  std::vector<double> lowest;
  for (const auto& processes : problem.parts) lowest.push_back(std::ranges::min(processes, {}, &Process::lo).lo);
  const LimitUse worst = worst_use(problem.limits, lowest);
  return {worst.limit, problem.limits.need(worst.limit, lowest), problem.limits.room[worst.limit]};
}

}  // namespace

Process fixed_process(double tolerance, double cost) { return {CostLaw::constant(cost), tolerance, tolerance}; }

std::vector<Process> available_values(const CostLaw& cost, std::span<const double> tolerances) {
  std::vector<Process> processes;
  for (const double tolerance : tolerances) processes.push_back(fixed_process(tolerance, cost.at(tolerance)));
  return processes;
}

AllocationOutcome least_cost(const AllocationProblem& problem, const SearchOptions& options) {
  const std::vector<double> effects = effects_by_room(problem);
  const auto sized = sized_problem(problem, effects);
  if (const auto* infeasible = std::get_if<Infeasible>(&sized)) return *infeasible;
  if (const auto* unbounded = std::get_if<Unbounded>(&sized)) return *unbounded;
  const SizedProblem& ready = std::get<SizedProblem>(sized);
  const bool choice = std::ranges::any_of(ready.processes, [](const auto& processes) { return processes.size() > 1; });
  auto found = choice ? branch_and_bound(problem, ready, options) : without_choice(problem, ready);
  if (!found) return together(problem);
  complete(problem, *found);
  return *std::move(found);
}

}  // namespace poesy
