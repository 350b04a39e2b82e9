#pragma once

#include <algorithm>

namespace poesy::linalg {

/// Minimises a sum of squares by damped Gauss-Newton steps (Levenberg 1944, Marquardt 1963). No step increases the sum.
/// So the iteration stays in the valley where it began, even if the squares cannot all vanish and undamped steps would
/// jump. Returns whether it converged: whether a step was shorter than `shortest`. The type Problem has these members:
///
///     double sum_of_squares()               the sum at the present point
///     double try_step(double damping)       computes a step whose normal matrix has its diagonal times
///                                           1 + damping; returns its length
///     double tried_sum_of_squares()         the sum after that step
///     void take_step()                      makes that step
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
