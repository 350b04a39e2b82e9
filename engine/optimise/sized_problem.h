#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "engine/optimise/least_cost.h"

/// The least-cost problem (AllocationProblem) in terms of sizes (T^2, or T for Stacking::worst_case), in which limits
/// are linear. Each limit is divided by its room (the largest combined effect that keeps the limit), so its room is 1.
namespace poesy {

/// The process of the inner part of a pair (Within). Bounds are sizes (T^2, or T for Stacking::worst_case).
struct InnerProcess {
  CostLaw cost;       ///< cost as a function of the tolerance
  double lo;          ///< least size
  double hi;          ///< largest size
  std::size_t index;  ///< position of the process in the list of its part in AllocationProblem::parts
  std::size_t part;   ///< position of the inner part among all parts
  double share;       ///< the size of the inner part is at most share x size of the outer part
  bool left_out;  ///< true if the inner part is left out: it costs nothing and its size is exactly share x size of the
                  ///< outer part
};

/// The effects of a part, and of the inner part of its pair, on one limit.
struct Effects {
  double own;    ///< effect of the part, >= 0
  double inner;  ///< effect of a pair's inner part; may be negative, but own + share x inner is >= 0
};

/// A process whose bounds are sizes (T^2, or T for Stacking::worst_case) instead of tolerances. In a pair (Within), a
/// process of the outer part also describes a process of the inner part.
struct SizedProcess {
  CostLaw cost;  ///< cost as a function of the tolerance
  double lo;     ///< least size
  double hi;  ///< largest size, finite after presolve: at most the size that the limits allow if all other parts are at
              ///< their lowest sizes
  std::size_t index;  ///< position of the process in the list of its part in AllocationProblem::parts
  std::optional<InnerProcess> inner = {};  ///< process of the pair's inner part; none if the part is in no pair

  /// Returns true if the process allows only one size, and so does the process of the inner part, if there is one.
  bool single() const { return lo == hi && (!inner || inner->left_out || inner->lo == inner->hi); }
  double fixed_cost() const;  ///< The cost that does not depend on sizes.
  /// The least share of a limit's room (the largest sum of effects that keeps the limit) that sizes of this process
  /// use. effects: effects on this limit, divided by its room.
  double least_use(const Effects& effects) const;
};

/// [limits x parts] The effects of the parts on the limits, divided by the rooms of the limits. They do not depend on
/// the choice of processes.
std::vector<double> effects_by_room(const AllocationProblem& problem);

/// The share of a limit's room that is left unused, so that rounding does not break the limit, in whatever order the
/// effects of the parts are added.
double rounding_margin(std::size_t parts);

/// The scalar product of two vectors, accumulated in eight partial sums.
double dot(std::span<const double> a, std::span<const double> b);

/// The least-cost problem in terms of sizes (T^2, or T for Stacking::worst_case).
struct SizedProblem {
  Stacking stacking;                   ///< how effects add up, which defines the size of a tolerance
  std::size_t limits;                  ///< L, the number of limits
  std::span<const double> effects;     ///< [limits x parts] effects divided by rooms, from effects_by_room()
  std::vector<double> largest_effect;  ///< [parts] largest magnitude of a part's effects over all limits
  std::vector<std::vector<SizedProcess>> processes;  ///< [parts] processes of each part, ascending by lo
                                                     ///< except for the outer parts of pairs
  /// [limits] 1 for a tight limit, 0 for others. The lowest sizes of the parts use up the room of a tight limit, except
  /// for rounding, so the parts that affect it are fixed at these sizes.
  std::vector<char> tight;
  /// Pairs of parts (Within). Processes of the outer part also describe the inner part (SizedProcess::inner); in the
  /// list `processes`, the inner part itself has only one process, of size 0 and without cost.
  std::span<const Within> pairs = {};

  std::size_t parts() const { return processes.size(); }  ///< N, the number of parts.
  /// [parts] The effects of all parts on limit l.
  std::span<const double> row(std::size_t l) const { return effects.subspan(l * parts(), parts()); }
  /// The effects of a part, and of the inner part of its pair, on one limit.
  Effects effects_on(std::size_t l, std::size_t part) const;
};

/// The allowed processes of a part: positions [first, last) in its list, at least one.
struct ProcessRange {
  std::size_t first;  ///< first position in the part's list in SizedProblem::processes
  std::size_t last;   ///< one past the last position

  std::size_t size() const { return last - first; }  ///< The number of processes.
};

/// [parts] The range of all processes for each part.
std::vector<ProcessRange> all_processes(const SizedProblem& problem);

/// [parts] The lowest size of each part among its allowed processes. It is 0 for both parts of a pair, because the
/// sizes of a pair that use a limit least differ from limit to limit.
std::vector<double> lowest(const SizedProblem& problem, std::span<const ProcessRange> allowed);

/// The least share of the room of limit l that all parts together use with their allowed processes. lo: lowest() for
/// the same processes.
double least_use(const SizedProblem& problem, std::size_t l, std::span<const ProcessRange> allowed,
                 std::span<const double> lo);

/// Presolve: the problem in terms of sizes, with bounds as tight as limits and costs allow. effects:
/// effects_by_room(problem), to which the result keeps a reference.
std::variant<SizedProblem, Infeasible, Unbounded> sized_problem(const AllocationProblem& problem,
                                                                std::span<const double> effects);

/// The problem with one process for each part. choice: [parts] position of this process. None if the lowest sizes then
/// break a limit.
std::optional<SizedProblem> with_processes(const SizedProblem& problem, std::span<const std::size_t> choice);

}  // namespace poesy
