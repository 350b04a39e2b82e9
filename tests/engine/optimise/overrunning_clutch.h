#pragma once

#include <cmath>
#include <vector>

#include "engine/optimise/least_cost.h"

/// The overrunning clutch of Feng and Kusiak (1997, J. Manuf. Sci. Eng. 119, 603-610): y = acos((X1 + (X2 + X3) / 2) /
/// (X4 - (X2 + X3) / 2)), mm and rad.
namespace poesy::testing {

/// The limit 0.035 rad on the deviation of y, for root-sum-square or worst-case stacking of the tolerances (mm).
inline ToleranceLimits clutch_limits(Stacking stacking) {
  const double hub = 55.29;
  const double roller = 22.86;
  const double cage = 101.60;
  const double width = cage - roller;
  const double cosine = (hub + roller) / width;
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const double by_roller = 0.5 * (1.0 + cosine) / (width * sine);
  ToleranceLimits limits{stacking, 4, {1.0 / (width * sine), by_roller, by_roller, cosine / (width * sine)}, {0.035}};
  limits.room[0] = size_of(limits.room[0], stacking);
  for (double& effect : limits.effects) effect = size_of(effect, stacking);
  return limits;
}

/// The manufacturing processes of the four parts: cost a + b / T and the range of T (mm).
inline std::vector<std::vector<Process>> clutch_processes() {
  const auto process = [](double fixed, double b, double lo, double hi) {
    return Process{CostLaw::reciprocal(fixed, b), lo, hi};
  };
  return {{process(10, .015, .015, .08), process(5, .5, .06, .15), process(3.5, .75, .12, .25)},
          {process(8, .25, .02, .15), process(3, .65, .08, .30)},
          {process(2.5, .3, .04, .20), process(5, .045, .12, .25)},
          {process(4, .56, .08, .12), process(6, .16, .15, .25), process(.5, .88, .2, .4)}};
}

inline AllocationProblem clutch_problem(Stacking stacking) { return {clutch_limits(stacking), clutch_processes()}; }

}  // namespace poesy::testing
