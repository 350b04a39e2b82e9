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

/// As result files have them, in the order of SolveStatus.
inline constexpr std::array<std::string_view, 6> kStatusNames{"converged", "stagnated",  "iteration_cap",
                                                              "singular",  "non_finite", "not_assembled"};

/// The same in the words of a report, in the order of SolveStatus.
inline constexpr std::array<std::string_view, kStatusNames.size()> kStatusMeanings{
    "the change fell below the tolerance",
    "as exact as the arithmetic allows; counts as converged",
    "still changing after the most iterations allowed",
    "the equations have no unique solution",
    "a value overflowed or became undefined",
    "cannot be assembled: no way to close its loops exists"};

/// A solve that reached its fixed point, to the tolerance or to rounding.
constexpr bool solved(SolveStatus status) {
  return status == SolveStatus::converged || status == SolveStatus::stagnated;
}

/// A solve whose last iterate is a number that says something of a machine.
constexpr bool usable(SolveStatus status) { return solved(status) || status == SolveStatus::iteration_cap; }

}  // namespace poesy
