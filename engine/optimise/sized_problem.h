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

/// A process in terms of sizes.
struct SizedProcess {
  CostLaw cost;       ///< cost as a function of the tolerance
  double lo;          ///< least size
  double hi;          ///< largest size, finite: at most what the limits leave when all other parts are at their lowest
  std::size_t index;  ///< position in AllocationProblem::parts

  bool single() const { return lo == hi; }  ///< Whether it has only one size.
  /// The size in [lo, hi] that minimises cost + price x size.
  double size_at(double price, Stacking stacking) const;
};

/// The effects divided by the rooms, [L x N]. They do not depend on the choice of processes.
std::vector<double> effects_by_room(const ToleranceLimits& limits);

/// The share of a room that is left unused by sums over N parts, so that no order of additions breaks a limit.
double rounding_margin(std::size_t parts);

/// sum of a_k b_k, accumulated in eight sums.
double dot(std::span<const double> a, std::span<const double> b);

/// The whole problem in terms of sizes.
struct SizedProblem {
  Stacking stacking;                                 ///< how effects add up, which defines sizes
  std::size_t limits;                                ///< L
  std::span<const double> effects;                   ///< [L x N], effects_by_room()
  std::vector<double> largest_effect;                ///< [N] largest effect of the part on any limit
  std::vector<std::vector<SizedProcess>> processes;  ///< [N] processes of each part, ascending by lo
  /// [L] 1 for limits that the lowest bounds use up to rounding; their parts are fixed at these bounds.
  std::vector<char> tight;

  std::size_t parts() const { return processes.size(); }  ///< N
  /// [N] effects on one limit.
  std::span<const double> row(std::size_t l) const { return effects.subspan(l * parts(), parts()); }
};

/// [N] the lowest size of each part.
std::vector<double> lowest(const SizedProblem& problem);

/// The problem with bounds as tight as limits and costs allow (presolve). Refers to effects.
std::variant<SizedProblem, Infeasible, Unbounded> sized_problem(const AllocationProblem& problem,
                                                                std::span<const double> effects);

/// The problem with one process of each part, chosen by position; none if their lowest bounds break a limit.
std::optional<SizedProblem> with_processes(const SizedProblem& problem, std::span<const std::size_t> choice);

}  // namespace poesy
