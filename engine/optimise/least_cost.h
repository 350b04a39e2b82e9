#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "engine/optimise/cost_law.h"
#include "engine/optimise/tolerance_limits.h"

/// Tolerances with the least cost under limits, with a proof. In T^2 (in T for Stacking::worst_case), limits are linear
/// and costs are convex. Multipliers of the limits therefore give a lower bound on the cost of all tolerances that keep
/// the limits: theory.md, D65.
namespace poesy {

/// One way of making a part.
struct Process {
  CostLaw cost;  ///< cost as a function of the tolerance
  double lo;     ///< smallest tolerance that the process can keep, SI, >= 0
  double hi;  ///< largest tolerance, SI, >= lo; equal to lo for a single value, infinite if the process has no largest
              ///< tolerance
};

/// The only process of a part whose tolerance (SI) is given and not chosen.
Process fixed_process(double tolerance, double cost = 0.0);

/// One process for each available tolerance (SI), such as the grades of a standard. The law gives the cost of each.
std::vector<Process> available_values(const CostLaw& cost, std::span<const double> tolerances);

/// When the inner part of a pair (Within) may be left out. A part that is left out has no tolerance of its own and
/// costs nothing.
enum class LeftOut {
  never,
  by_choice,        ///< left out if that costs less
  where_it_is_void  ///< left out only if the outer part is so fine that no process of the inner part fits in it
};

/// A pair of parts, in which the size of the inner part is at most a share of the size of the outer part. An example is
/// an orientation zone (width T_o) within a location zone (width T): T_o^2 <= T^2 / 2. Effects of the inner part may be
/// negative, because with a finer orientation the middle of the feature may move further in the location zone. Effects
/// of the outer part, and outer + share x inner, are not negative.
struct Within {
  std::size_t inner;  ///< position of the part whose size is bounded
  std::size_t outer;  ///< position of the part that bounds it
  double share;       ///< size of the inner part <= share x size of the outer part; share > 0
  LeftOut left_out;   ///< whether the inner part may be left out: its size is then exactly share x size of the outer
                      ///< part, at no cost
};

/// The problem: N parts, each with one or more processes, under L limits.
struct AllocationProblem {
  ToleranceLimits limits;                   ///< limits on N parts; there may be none
  std::vector<std::vector<Process>> parts;  ///< [parts] processes of each part, of which one is chosen
  std::vector<Within> pairs = {};           ///< pairs of parts; a part is in at most one pair
};

/// When branch and bound ends, and how many choices it returns. Unused if each part has only one process.
struct SearchOptions {
  /// The search ends when the cost is proven to exceed the least cost by at most this share. Make it larger for many
  /// parts with lists of values: most nodes go into the last digits, and the errors that tolerances permit are hardly
  /// known to 1e-6.
  double relative_gap = 1e-9;
  /// The number of choices of processes to return besides the best one, cheapest first. Each of them makes the search
  /// longer, because nodes are pruned by the cost of the worst choice that is kept.
  std::size_t alternatives = 0;
  /// The largest number of nodes. If it is reached, the search ends, and LeastCost::gap() is larger than asked. Make it
  /// smaller if a good choice soon is worth more than a proof: the default takes 4 s for 71 parts of which many are
  /// alike (D65).
  std::size_t max_nodes = 20000;
};

/// Whether a tolerance is at a bound of its process; single: the process allows only one tolerance.
enum class AtBound { none, lower, upper, single };

/// A choice of one process for each part, and the tolerances with the least cost for this choice.
struct Allocation {
  std::vector<std::size_t> process;  ///< [parts] position of the chosen process among the processes of each part
  std::vector<double> tolerance;     ///< [parts] SI; they keep every limit, also in floating-point sums
  double cost;                       ///< sum over all parts
  /// Inner parts of pairs that are left out. Their `tolerance` is the largest that the outer part allows; their
  /// `process` is 0.
  std::vector<std::size_t> left_out = {};
};

/// The tolerances with the least cost and the proof that nothing costs less.
struct LeastCost {
  Allocation best;             ///< the cheapest known choice that keeps the limits
  double lower_bound;          ///< proven lower bound on the cost of all tolerances that keep bounds and limits
  std::vector<AtBound> bound;  ///< [parts] whether each tolerance of `best` is at a bound
  /// [limits] Cost saved per unit of additional room, >= 0; 0 for a limit that is not used up.
  std::vector<double> multiplier;
  /// [limits] Multipliers if processes may be mixed; equal to `multiplier` if no part has a choice.
  std::vector<double> relaxed;
  LimitUse use;  ///< the limit with the largest share of its room in use, share <= 1; {0, 0} if there are no limits
  /// The next cheapest choices of processes, cheapest first; at most SearchOptions::alternatives.
  std::vector<Allocation> next;
  std::size_t nodes = 0;  ///< number of nodes of branch and bound; 0 if no part has a choice

  /// The largest amount by which the cost may exceed the least cost, >= 0.
  double gap() const { return best.cost - lower_bound; }
};

/// A problem without a least cost. The listed parts affect no limit and have no upper bound, so their tolerances may
/// grow without end.
struct Unbounded {
  std::vector<std::size_t> parts;  ///< positions of the parts
};

/// The result of an allocation: tolerances, or the reason why there are none.
using AllocationOutcome = std::variant<LeastCost, Infeasible, Unbounded>;

/// Finds the tolerances with the least cost. A part whose process costs the same at any tolerance gets the lowest one,
/// or the largest if it affects no limit. The same problem gives the same bits wherever the mathematics library gives
/// the same roots, exponentials and powers.
///
/// The problem is infeasible if the lowest bounds need more than the room of a limit, or leave no room for a part whose
/// cost would then be infinite. With pairs it is also infeasible if no sizes within bounds keep all limits at once. If
/// the lowest bounds leave hardly any room, rounding determines the gap, up to 1e-13 of the sum of multiplier x room.
///
/// Preconditions: room and effects are finite; effects are not negative (except as in Within); every part has a
/// process; lo <= hi; hi > 0 if the law divides by T; max_nodes > 0. With pairs also: limits are sums of squares; some
/// process of the inner part fits in one of the outer part, or the inner part may be left out; a process of constant
/// cost has one size.
AllocationOutcome least_cost(const AllocationProblem& problem, const SearchOptions& options = {});

}  // namespace poesy
