#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "engine/optimise/cost_law.h"
#include "engine/optimise/tolerance_limits.h"

/// Tolerances with the least cost under limits, with a proof. In the size T^2 of a tolerance T (in T for
/// Stacking::worst_case), limits are linear and costs are convex. Therefore Lagrange multipliers of the limits give a
/// lower bound on the cost of all tolerances that keep the limits (engine/docs/theory.md; decision D65).
namespace poesy {

/// One way of making a part.
struct Process {
  CostLaw cost;  ///< cost as a function of the tolerance
  double lo;     ///< smallest tolerance that the process can keep, SI, >= 0
  /// Largest tolerance, SI, >= lo; equal to lo if the process makes a single tolerance, infinite if there is no largest
  /// one.
  double hi;
};

/// The only process of a part whose tolerance (SI) is given and not chosen.
Process fixed_process(double tolerance, double cost = 0.0);

/// One process for each available tolerance (SI), such as the grades of a standard. cost: the law that gives the cost
/// of each.
std::vector<Process> available_values(const CostLaw& cost, std::span<const double> tolerances);

/// When the inner part of a pair (Within) may be left out of the drawing. A part that is left out has no tolerance of
/// its own and costs nothing.
enum class LeftOut {
  never,
  by_choice,        ///< left out if the total cost is then lower
  where_it_is_void  ///< left out only if the outer part is so small that no process of the inner part fits in it
};

/// A pair of parts, in which the size (T^2, or T for Stacking::worst_case) of the inner part is at most a share of the
/// size of the outer part. An example is an orientation zone (width T_o) within a location zone (width T): T_o^2 <= T^2
/// / 2. Effects of the inner part may be negative, because with a finer orientation the middle of the feature may move
/// further in the location zone. On each limit, the effect of the outer part is not negative, nor is the sum of this
/// effect and share x effect of the inner part.
struct Within {
  std::size_t inner;  ///< position of the inner part, whose size is bounded
  std::size_t outer;  ///< position of the outer part, which bounds it
  double share;       ///< size of the inner part <= share x size of the outer part; share > 0
  LeftOut left_out;   ///< whether the inner part may be left out: its size is then exactly share x size of the outer
                      ///< part, at no cost
};

/// The problem of least cost: parts, each with one or more processes, under limits. A part is a set of errors that have
/// one common tolerance.
struct AllocationProblem {
  ToleranceLimits limits;                   ///< limits on the parts; there may be none
  std::vector<std::vector<Process>> parts;  ///< [parts] processes of each part, of which one is chosen
  std::vector<Within> pairs = {};           ///< pairs of parts; a part is in at most one pair
};

/// When branch and bound ends, and how many choices of processes it returns. Unused if each part has only one process.
struct SearchOptions {
  /// The search ends when the cost is proven to exceed the least cost by at most this share. A larger share shortens
  /// the search if many parts have lists of tolerances: most nodes serve the last digits of the proof, although the
  /// effects of tolerances are hardly known to 1e-6.
  double relative_gap = 1e-9;
  /// The number of further choices of processes to return (LeastCost::next). Each of them makes the search longer,
  /// because nodes are pruned by the cost of the worst choice that is returned.
  std::size_t alternatives = 0;
  /// The largest number of nodes. If it is reached, the search ends, and LeastCost::gap() is larger than relative_gap
  /// asks. A smaller number gives a good choice sooner, but a weaker proof. The default takes 4 s for 71 parts of which
  /// many are alike (decision D65).
  std::size_t max_nodes = 20000;
};

/// Whether a tolerance is at a bound of its process; single: the process allows only one tolerance.
enum class AtBound { none, lower, upper, single };

/// A choice of one process for each part, and the tolerances with the least cost for this choice.
struct Allocation {
  std::vector<std::size_t> process;  ///< [parts] position of the chosen process among the processes of each part
  std::vector<double> tolerance;  ///< [parts] tolerances, SI; they keep every limit, also as computed in floating point
  double cost;                    ///< sum of the costs of all parts
  /// Positions of the inner parts of pairs that are left out. Their `tolerance` is the largest that the outer part
  /// allows; their `process` is 0.
  std::vector<std::size_t> left_out = {};
};

/// The tolerances with the least cost that was found, and a lower bound that proves by how much another choice could
/// cost less.
struct LeastCost {
  Allocation best;             ///< the cheapest known choice that keeps the limits
  double lower_bound;          ///< proven lower bound on the cost of all tolerances that processes and limits allow
  std::vector<AtBound> bound;  ///< [parts] whether each tolerance of `best` is at a bound
  /// [limits] Cost saved per unit of additional room (ToleranceLimits::room), >= 0; 0 for a limit that is not used up.
  std::vector<double> multiplier;
  /// [limits] Multipliers of the problem in which processes may be mixed (BestResponse); equal to `multiplier` if each
  /// part has one process.
  std::vector<double> relaxed;
  LimitUse use;  ///< the limit of which the largest share is used, share <= 1; {0, 0} if there are no limits
  /// The next cheapest choices of processes, cheapest first; at most SearchOptions::alternatives.
  std::vector<Allocation> next;
  std::size_t nodes = 0;  ///< number of nodes that branch and bound expanded; 0 if each part has one process

  /// The largest amount by which the cost of `best` may exceed the least cost, >= 0.
  double gap() const { return best.cost - lower_bound; }
};

/// A problem without a least cost: the listed parts affect no limit and have no upper bound, so larger tolerances are
/// always possible.
struct Unbounded {
  std::vector<std::size_t> parts;  ///< positions of the parts
};

/// The result of an allocation: tolerances, or the reason why there are none.
using AllocationOutcome = std::variant<LeastCost, Infeasible, Unbounded>;

/// Finds the tolerances with the least cost. A part whose process costs the same at any tolerance gets the smallest
/// tolerance, or the largest if it affects no limit. The same problem gives the same bits wherever the mathematics
/// library gives the same roots, exponentials and powers.
///
/// The problem is infeasible if the smallest tolerances break a limit, or use it up so that a part must stay at a
/// tolerance of infinite cost. With pairs it is also infeasible if no tolerances within bounds keep all limits at once.
/// If the smallest tolerances leave hardly any room in a limit, rounding determines the gap, up to 1e-13 of the sum of
/// multiplier x room.
///
/// Preconditions: room and effects are finite; effects are not negative, except as Within allows; every part has a
/// process; lo <= hi; hi > 0 if the law divides by T; max_nodes > 0. With pairs also: limits are sums of squares; some
/// process of the inner part fits in one of the outer part, or the inner part may be left out; a process of constant
/// cost has one size.
AllocationOutcome least_cost(const AllocationProblem& problem, const SearchOptions& options = {});

}  // namespace poesy
