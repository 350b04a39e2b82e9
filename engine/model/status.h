#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace poesy {

/// How the solve of one sample ended.
enum class SolveStatus : std::uint8_t {
  converged,      ///< the change in an iteration fell below the tolerance (SolverOptions::tolerance)
  stagnated,      ///< the change stays at rounding level without falling further: as exact as doubles allow
  iteration_cap,  ///< the solution still changed after the allowed number of iterations
  singular,       ///< the matrix of the equations cannot be factored, or the solution is beyond a singular pose
  non_finite,     ///< a value overflowed or became undefined
  not_assembled,  ///< the loops of a machine with these errors cannot be closed near its nominal pose, or its state
                  ///< meets a singularity while the errors grow from zero
  by_series       ///< not solved: the outcome follows from a certified series (engine/run/series_model.h)
};

/// The names of SolveStatus in result files, in the order of the enum.
inline constexpr std::array<std::string_view, 7> kStatusNames{
    "converged", "stagnated", "iteration_cap", "singular", "non_finite", "not_assembled", "by_series"};

/// The meanings of SolveStatus in reports, in the order of the enum.
inline constexpr std::array<std::string_view, kStatusNames.size()> kStatusMeanings{
    "the change fell below the tolerance",
    "as exact as the arithmetic allows; counts as converged",
    "still changing after the most iterations allowed",
    "the equations have no unique solution",
    "a value overflowed or became undefined",
    "cannot be assembled: its loops do not close, or only past a singular pose",
    "computed from a series through solves, which further solves certified"};

/// Returns true if a solve converged, to the tolerance or to rounding level, or if a certified series replaces it.
constexpr bool solved(SolveStatus status) {
  return status == SolveStatus::converged || status == SolveStatus::stagnated || status == SolveStatus::by_series;
}

/// Returns true if the last iterate of a solve may be used as an approximate solution.
constexpr bool usable(SolveStatus status) { return solved(status) || status == SolveStatus::iteration_cap; }

}  // namespace poesy
