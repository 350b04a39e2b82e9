#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace poesy {

/// How one solve ended.
enum class SolveStatus : std::uint8_t {
  converged,      ///< the change of the residual fell below the tolerance
  stagnated,      ///< the change stays at rounding level without falling further: as exact as doubles allow
  iteration_cap,  ///< still changing after the allowed number of iterations
  singular,       ///< the normal matrix cannot be factored
  non_finite,     ///< a value overflowed or became undefined
  not_assembled   ///< no solution exists: the loops of a machine with these errors cannot be closed
};

/// The names of SolveStatus in result files, in its order.
inline constexpr std::array<std::string_view, 6> kStatusNames{"converged", "stagnated",  "iteration_cap",
                                                              "singular",  "non_finite", "not_assembled"};

/// The meanings of SolveStatus in reports, in its order.
inline constexpr std::array<std::string_view, kStatusNames.size()> kStatusMeanings{
    "the change fell below the tolerance",
    "as exact as the arithmetic allows; counts as converged",
    "still changing after the most iterations allowed",
    "the equations have no unique solution",
    "a value overflowed or became undefined",
    "cannot be assembled: no way to close its loops exists"};

/// Whether a solve reached its fixed point, to the tolerance or to rounding.
constexpr bool solved(SolveStatus status) {
  return status == SolveStatus::converged || status == SolveStatus::stagnated;
}

/// Whether the last iterate of a solve describes a machine.
constexpr bool usable(SolveStatus status) { return solved(status) || status == SolveStatus::iteration_cap; }

}  // namespace poesy
