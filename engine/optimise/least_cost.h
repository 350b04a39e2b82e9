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
  CostLaw cost;  ///< cost as a function of the tolerance
  double lo;     ///< least tolerance, SI, >= 0
  double hi;     ///< largest tolerance, >= lo; infinite where limits alone bound it; equal to lo for a single value
};

/// The only process of a part whose tolerance is given.
Process fixed_process(double tolerance, double cost = 0.0);

/// One process for each tolerance that can be had, such as the grades of a standard, at its cost by a law.
std::vector<Process> available_values(const CostLaw& cost, std::span<const double> tolerances);

/// The problem: N parts, each with one or more processes, under L limits.
struct AllocationProblem {
  ToleranceLimits limits;                   ///< limits on N parts; there may be none
  std::vector<std::vector<Process>> parts;  ///< [N] processes of each part, of which one is chosen
};

/// When branch and bound ends, and what it gives. Where no part has a choice of processes none of it matters.
struct SearchOptions {
  /// The search ends when the cost is proven to be within this share of the least. Make it larger for many parts with
  /// lists of values, where the last digits take most nodes; 1e-6 is far below what a tolerance is known to.
  double relative_gap = 1e-9;
  /// How many next-best choices of processes are wanted too. Each makes the search longer, because nodes are pruned by
  /// the cost of the worst choice that is kept.
  std::size_t alternatives = 0;
  /// The search ends after so many nodes; the gap is larger then, and says so. Make it smaller where a good choice at
  /// once is worth more than a proof: 71 parts of three kinds take 4 s for the default.
  std::size_t max_nodes = 20000;
};

/// Whether a tolerance is at a bound of its process.
enum class AtBound { none, lower, upper, single };

/// A choice of processes and the tolerances at least cost for it.
struct Allocation {
  std::vector<std::size_t> process;  ///< [N] position among the processes of each part
  std::vector<double> tolerance;     ///< [N] SI; they keep every limit, and sums that are rounded keep it too
  double cost;                       ///< sum over all parts
};

/// The tolerances at least cost and the proof that nothing costs less.
struct LeastCost {
  Allocation best;             ///< no choice that keeps the limits is known to cost less
  double lower_bound;          ///< no tolerances within bounds and limits cost less: a proof, rounding counted
  std::vector<AtBound> bound;  ///< [N] where each tolerance of best is
  std::vector<double>
      multiplier;                ///< [L] >= 0: what one unit more of room would save; 0 for a limit that does not bind
  std::vector<double> relaxed;   ///< [L] the same where processes may be mixed; multiplier itself without a choice
  LimitUse use;                  ///< the limit that is used most; share <= 1. {0, 0} without limits
  std::vector<Allocation> next;  ///< next-best choices of processes by cost, as many as options ask for and exist
  std::size_t nodes = 0;         ///< nodes of branch and bound; 0 without a choice

  double gap() const { return best.cost - lower_bound; }  ///< >= 0: the least cost is no more than this below
};

/// A problem without a least cost: these parts have no effect on any limit and no upper bound, so that their tolerances
/// may grow for ever.
struct Unbounded {
  std::vector<std::size_t> parts;  ///< positions of the parts
};

/// The result of an allocation: tolerances, or why there are none.
using AllocationOutcome = std::variant<LeastCost, Infeasible, Unbounded>;

/// The tolerances at least cost. A part whose process costs the same at any tolerance gets the lowest one, or the
/// largest if it has no effect. The same problem gives the same bits wherever the mathematics library gives the same
/// roots, exponentials and powers.
///
/// The problem is infeasible where the lowest bounds need more than the room of a limit, or leave nothing at all to a
/// part whose cost is infinite then. Where they leave next to nothing, rounding makes the gap: up to 1e-13 of the sum
/// of multiplier x room.
///
/// Preconditions: room and effects are finite, effects are not negative, every part has a process, with lo <= hi, and
/// hi > 0 where its law divides by T; max_nodes > 0.
AllocationOutcome least_cost(const AllocationProblem& problem, const SearchOptions& options = {});

}  // namespace poesy
