#pragma once

#include <algorithm>

namespace poesy::linalg {

/// Goes downhill to a place where a sum of squares is least, by damped steps (Levenberg 1944, Marquardt 1963). No step
/// leads up, so that it ends in the valley where it began, also where no square can vanish and where steps without
/// damping leap. Returns whether it came to rest: whether a step was shorter than `shortest`.
///
///     double sum_of_squares()               where the problem stands
///     double try_step(double damping)       the length of the step whose normal matrix has its diagonal times
///                                           1 + damping
///     double tried_sum_of_squares()         where that step leads
///     void take_step()                      goes there
template <class Problem>
bool comes_to_rest(Problem& problem, double shortest) {
  constexpr int kMostSteps = 200;
  constexpr double kLeastDamping = 1e-12;
  double damping = 1e-3;
  double here = problem.sum_of_squares();
  for (int n = 0; n < kMostSteps; ++n) {
    const double length = problem.try_step(damping);
    const double there = problem.tried_sum_of_squares();
    const bool leads_down = there < here;
    if (leads_down) {
      problem.take_step();
      here = there;
    }
    if (length < shortest) return true;
    damping = leads_down ? std::max(damping / 4.0, kLeastDamping) : damping * 5.0;
  }
  return false;
}

}  // namespace poesy::linalg
