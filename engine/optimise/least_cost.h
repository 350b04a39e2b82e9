#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "engine/optimise/cost_law.h"
#include "engine/optimise/tolerance_limits.h"

/// Tolerances at least cost under limits, with a proof. In T^2 (in T, in the worst case) limits are linear and costs
/// convex, so the multipliers of the limits give a lower bound on the cost of all tolerances that keep the limits:
/// theory.md, D65.
namespace poesy {

/// One way of making a part.
struct Process {
  CostLaw cost;  ///< over T
  double lo;     ///< least tolerance, SI, >= 0
  double hi;     ///< largest one, >= lo, infinite where nothing but the limits bounds it; lo itself for a single value
};

/// The only way of a part that has this tolerance already.
Process fixed_process(double tolerance, double cost = 0.0);

/// One process for each tolerance that can be had, such as the grades of a standard, at its cost by a law.
std::vector<Process> available_values(const CostLaw& cost, std::span<const double> tolerances);

/// What to allocate.
struct AllocationProblem {
  ToleranceLimits limits;                   ///< of N parts; none is allowed
  std::vector<std::vector<Process>> parts;  ///< [N] of each part its processes, one or more, of which one is chosen
};

/// When a search among processes ends, and what it gives. Without a choice none of it matters.
struct SearchOptions {
  double relative_gap = 1e-9;      ///< the search ends when the cost is proven to be within this share of the least
  std::size_t alternatives = 0;    ///< how many next-best choices of processes are wanted too
  std::size_t most_nodes = 20000;  ///< nodes of the search; when they are used up the gap is larger, and says so
};

/// Where a tolerance is within the bounds of its process.
enum class AtBound { none, lower, upper, single };

/// A choice of processes and its tolerances at least cost.
struct Allocation {
  std::vector<std::size_t> process;  ///< [N] position among those of each part
  std::vector<double> tolerance;     ///< [N] SI; they keep every limit, and sums that are rounded keep it too
  double cost;                       ///< of all parts
};

/// The tolerances at least cost and why nothing costs less.
struct LeastCost {
  Allocation best;             ///< no choice that keeps the limits is known to cost less
  double lower_bound;          ///< no tolerances within bounds and limits cost less: a proof, rounding counted
  std::vector<AtBound> bound;  ///< [N] of best
  std::vector<double>
      multiplier;                ///< [L] >= 0: what one unit more of room would save; 0 for a limit that sets no price
  std::vector<double> relaxed;   ///< [L] the same where processes may be mixed; multiplier itself without a choice
  LimitUse use;                  ///< of the limit that is used most; share <= 1. {0, 0} without limits
  std::vector<Allocation> next;  ///< other choices of processes by their cost, as many as were asked for and exist
  std::size_t nodes = 0;         ///< of the search; 0 without a choice

  double gap() const { return best.cost - lower_bound; }  ///< >= 0: the least cost is no more than this below
};

/// Parts that could be loosened for ever: they have no effect on any limit, and no upper bound.
struct WithoutEnd {
  std::vector<std::size_t> parts;  ///< by position
};

/// What comes of an allocation: tolerances, or why there are none.
using AllocationOutcome = std::variant<LeastCost, CannotBeMet, WithoutEnd>;

/// The tolerances at least cost. A part whose process costs the same at any tolerance gets the lowest one, or the
/// largest if it has no effect. The same problem has the same bits, where roots, exponentials and powers of the
/// mathematics library have.
///
/// Limits cannot be met where the lowest bounds need more than their room, or leave nothing at all to a part that costs
/// an infinite amount then. Where they leave next to nothing the gap is what rounding makes of it: up to 1e-13 of the
/// sum of multiplier x room.
///
/// Preconditions: room and effects are finite, effects are not negative, every part has a process, with lo <= hi, and
/// hi > 0 where its law divides by T; most_nodes > 0.
AllocationOutcome least_cost(const AllocationProblem& problem, const SearchOptions& options = {});

}  // namespace poesy
