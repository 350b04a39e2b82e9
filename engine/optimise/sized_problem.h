#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "engine/optimise/least_cost.h"

/// The problem of least cost in terms of sizes (T^2, or T in the worst case), in which limits are linear. The unit of
/// each limit is its room.
namespace poesy {

/// The process of the inner part of a pair (Within), in terms of sizes.
struct InnerProcess {
  CostLaw cost;       ///< cost as a function of the tolerance
  double lo;          ///< least size
  double hi;          ///< largest size
  std::size_t index;  ///< position in AllocationProblem::parts
  std::size_t part;   ///< position of the inner part
  double share;       ///< its size is at most share x size of the outer part
  bool left_out;      ///< it costs nothing and has exactly that size
};

/// The effects of the parts of a process on a limit.
struct Effects {
  double own;    ///< >= 0
  double inner;  ///< of the inner part of a pair; may be negative, but own + share x inner is not
};

/// A process in terms of sizes. Both parts of a pair have a common process, which is that of the outer part.
struct SizedProcess {
  CostLaw cost;       ///< cost as a function of the tolerance
  double lo;          ///< least size
  double hi;          ///< largest size, finite: at most what the limits leave when all other parts are at their lowest
  std::size_t index;  ///< position in AllocationProblem::parts
  std::optional<InnerProcess> inner = {};  ///< the inner part of a pair

  /// Whether it has only one size.
  bool single() const { return lo == hi && (!inner || inner->left_out || inner->lo == inner->hi); }
  double fixed_cost() const;  ///< The part of the cost that does not depend on sizes.
  /// The least use of a limit by the sizes that it allows.
  double least_use(const Effects& effects) const;
};

/// The effects divided by the rooms, [L x N]. They do not depend on the choice of processes.
std::vector<double> effects_by_room(const AllocationProblem& problem);

/// The share of a room that is left unused by sums over N parts, so that no order of additions breaks a limit.
double rounding_margin(std::size_t parts);

/// sum of a_k b_k, accumulated in eight sums.
double dot(std::span<const double> a, std::span<const double> b);

/// The whole problem in terms of sizes.
struct SizedProblem {
  Stacking stacking;                                 ///< how effects add up, which defines sizes
  std::size_t limits;                                ///< L
  std::span<const double> effects;                   ///< [L x N], effects_by_room()
  std::vector<double> largest_effect;                ///< [N] largest magnitude of its effects on limits
  std::vector<std::vector<SizedProcess>> processes;  ///< [N] processes of each part, ascending by lo
  /// [L] 1 for limits that the lowest bounds use up to rounding; their parts are fixed at these bounds.
  std::vector<char> tight;
  /// Pairs of parts. `processes` of the outer part are those of both; the inner part has one of size 0 without cost.
  std::span<const Within> pairs = {};

  std::size_t parts() const { return processes.size(); }  ///< N
  /// [N] effects on one limit.
  std::span<const double> row(std::size_t l) const { return effects.subspan(l * parts(), parts()); }
  /// The effects of a part, and of the inner part of its pair, on one limit.
  Effects effects_on(std::size_t l, std::size_t part) const;
};

/// The allowed processes of a part: [first, last) of its list, at least one.
struct ProcessRange {
  std::size_t first;  ///< position in SizedProblem::processes
  std::size_t last;   ///< one past the last position

  std::size_t size() const { return last - first; }  ///< The number of processes.
};

/// [N] all processes of each part.
std::vector<ProcessRange> all_processes(const SizedProblem& problem);

/// [N] the lowest size of each part among allowed processes; 0 for the parts of pairs, where each limit has its own.
std::vector<double> lowest(const SizedProblem& problem, std::span<const ProcessRange> allowed);

/// The least use of a limit by allowed processes. lo: lowest().
double least_use(const SizedProblem& problem, std::size_t l, std::span<const ProcessRange> allowed,
                 std::span<const double> lo);

/// The problem with bounds as tight as limits and costs allow (presolve). Refers to effects.
std::variant<SizedProblem, Infeasible, Unbounded> sized_problem(const AllocationProblem& problem,
                                                                std::span<const double> effects);

/// The problem with one process of each part, chosen by position; none if their lowest bounds break a limit.
std::optional<SizedProblem> with_processes(const SizedProblem& problem, std::span<const std::size_t> choice);

}  // namespace poesy
