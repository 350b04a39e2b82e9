#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "engine/optimise/least_cost.h"

/// An allocation in the sizes that limits add (T^2, or T in the worst case), with the room of every limit as unit.
namespace poesy {

/// A process in sizes.
struct SizedProcess {
  CostLaw cost;         ///< over the tolerance
  double lo;            ///< size
  double hi;            ///< size, finite: no larger than what the limits leave when all other parts are at their lowest
  std::size_t process;  ///< position among the processes of the part

  bool single() const { return lo == hi; }  ///< Whether there is nothing to choose.
  /// The size in [lo, hi] at which cost + price x size is least.
  double size_at(double price, Stacking stacking) const;
};

/// The effects over the rooms, which no choice changes: [L x N].
std::vector<double> effects_by_room(const ToleranceLimits& limits);

/// The part of a room that the sums of N parts are kept away from it, so that no order of additions breaks a limit.
double rounding_margin(std::size_t parts);

/// sum of a_k b_k, in eight sums.
double dot(std::span<const double> a, std::span<const double> b);

/// The whole problem in sizes.
struct SizedProblem {
  Stacking stacking;                             ///< what a size is
  std::size_t limits;                            ///< L
  std::span<const double> effects;               ///< [L x N], effects_by_room()
  std::vector<double> largest_effect;            ///< [N] of the part, on any limit
  std::vector<std::vector<SizedProcess>> menus;  ///< [N] processes by lo
  /// [L] 1 for limits that the lowest bounds fill up to rounding: their parts have these bounds alone.
  std::vector<char> full;

  std::size_t parts() const { return menus.size(); }  ///< N
  /// [N] effects on one limit.
  std::span<const double> row(std::size_t l) const { return effects.subspan(l * parts(), parts()); }
};

/// [N] the lowest size of each part.
std::vector<double> lowest(const SizedProblem& problem);

/// The problem, with what limits and costs say of the bounds. Refers to effects.
std::variant<SizedProblem, CannotBeMet, WithoutEnd> sized_problem(const AllocationProblem& problem,
                                                                  std::span<const double> effects);

/// The problem with one process of each part, by places in the menus; none where their lowest bounds break a limit.
std::optional<SizedProblem> with_chosen(const SizedProblem& problem, std::span<const std::size_t> places);

}  // namespace poesy
