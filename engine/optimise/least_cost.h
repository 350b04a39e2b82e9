#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "engine/optimise/cost_law.h"
#include "engine/optimise/tolerance_limits.h"

/// Tolerances at least cost under limits, with a proof. Limits are linear and costs convex in T^2 (in T for the worst
/// case), so multipliers of the limits give a lower bound on the cost of all tolerances that keep the limits:
/// theory.md, D65.
namespace poesy {

/// One way of making a part.
struct Process {
  CostLaw cost;  ///< cost as a function of the tolerance
  double lo;     ///< least tolerance, SI, >= 0
  double hi;     ///< largest tolerance, >= lo; infinite: only the limits bound it; equal to lo for a single value
};

/// The only process of a part whose tolerance is given.
Process fixed_process(double tolerance, double cost = 0.0);

/// One process for each available tolerance, such as the grades of a standard, with the cost of a law.
std::vector<Process> available_values(const CostLaw& cost, std::span<const double> tolerances);

/// When the inner part of a pair may be left out.
enum class LeftOut {
  never,
  by_choice,        ///< where that costs less
  where_it_is_void  ///< where the outer part is so fine that no process of the inner one fits in it
};

/// A pair of parts, of which the inner one has at most a share of the size of the outer one. An example is an
/// orientation zone within a location zone: T_o^2 <= T^2 / 2. Effects of the inner part may be negative, because a
/// finer orientation leaves more of the location to the middle of the feature; effects of the outer part, and outer +
/// share x inner, are not.
struct Within {
  std::size_t inner;  ///< position of the part whose size is bounded
  std::size_t outer;  ///< position of the part that bounds it
  double share;       ///< size of the inner part <= share x size of the outer part; 0 < share
  LeftOut left_out;   ///< whether the inner part may also have exactly this size and cost nothing
};

/// The problem: N parts, each with one or more processes, under L limits.
struct AllocationProblem {
  ToleranceLimits limits;                   ///< limits on N parts; there may be none
  std::vector<std::vector<Process>> parts;  ///< [N] processes of each part, of which one is chosen
  std::vector<Within> pairs = {};           ///< pairs of parts; a part is in one pair at most
};

/// When branch and bound ends, and what it returns. Unused if no part has a choice of processes.
struct SearchOptions {
  /// The search ends when the cost is proven to be within this share of the least. Make it larger for many parts with
  /// lists of values, where the last digits take most nodes; tolerances are hardly known to 1e-6.
  double relative_gap = 1e-9;
  /// The number of next-best choices of processes to return. Each makes the search longer, because nodes are pruned by
  /// the cost of the worst choice that is kept.
  std::size_t alternatives = 0;
  /// The largest number of nodes. If it is reached, the gap is larger, and the result has it. Make it smaller if a good
  /// choice soon is worth more than a proof: with 71 parts of three kinds the default takes 4 s.
  std::size_t max_nodes = 20000;
};

/// Whether a tolerance is at a bound of its process.
enum class AtBound { none, lower, upper, single };

/// A choice of processes and the tolerances at least cost for it.
struct Allocation {
  std::vector<std::size_t> process;  ///< [N] position among the processes of each part
  std::vector<double> tolerance;     ///< [N] SI; they keep every limit, also in rounded sums
  double cost;                       ///< sum over all parts
  /// Inner parts of pairs that are left out. `tolerance` has the largest that the outer parts allow; `process` is 0.
  std::vector<std::size_t> left_out = {};
};

/// The tolerances at least cost and the proof that nothing costs less.
struct LeastCost {
  Allocation best;  ///< the cheapest known choice that keeps the limits
  double
      lower_bound;  ///< a proven lower bound on the cost of all tolerances within bounds and limits, including rounding
  std::vector<AtBound> bound;  ///< [N] whether each tolerance of `best` is at a bound
  std::vector<double>
      multiplier;                ///< [L] >= 0: the saving per unit of additional room; 0 for a limit that does not bind
  std::vector<double> relaxed;   ///< [L] the same if processes may be mixed; equal to `multiplier` without a choice
  LimitUse use;                  ///< use of the limit that is used most; share <= 1. {0, 0} without limits
  std::vector<Allocation> next;  ///< next-best choices of processes by cost, at most as many as the options want
  std::size_t nodes = 0;         ///< nodes of branch and bound; 0 without a choice

  double gap() const {
    return best.cost - lower_bound;
  }  ///< >= 0: the cost exceeds the least cost by no more than this
};

/// A problem without a least cost: these parts have no effect on any limit and no upper bound, so their tolerances may
/// grow without end.
struct Unbounded {
  std::vector<std::size_t> parts;  ///< positions of the parts
};

/// The result of an allocation: tolerances, or why there are none.
using AllocationOutcome = std::variant<LeastCost, Infeasible, Unbounded>;

/// The tolerances at least cost. A part whose process costs the same at any tolerance gets the lowest one, or the
/// largest if it has no effect. The same problem gives the same bits wherever the mathematics library gives the same
/// roots, exponentials and powers.
///
/// The problem is infeasible if the lowest bounds need more than the room of a limit, or if they leave no room for a
/// part whose cost is then infinite. With pairs it is also infeasible if no sizes within bounds keep all limits at
/// once. If they leave hardly any room, rounding determines the gap, up to 1e-13 of the sum of multiplier x room.
///
/// Preconditions: room and effects are finite, effects are not negative (but see Within), every part has a process, lo
/// <= hi, hi > 0 if the law divides by T; max_nodes > 0. Pairs: limits are sums of squares; some process of the inner
/// part fits in one of the outer part, or may be left out; a process of a constant cost has one size.
AllocationOutcome least_cost(const AllocationProblem& problem, const SearchOptions& options = {});

}  // namespace poesy
