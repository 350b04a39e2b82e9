#pragma once

#include <algorithm>

namespace poesy::linalg {

/// Minimises a sum of squares by damped Gauss-Newton steps (Levenberg 1944, Marquardt 1963). Steps that would increase
/// the sum are not made, so the iteration stays in the valley of the sum in which it began, even if the least sum there
/// is not 0 and undamped steps would jump away. Returns true as soon as a step is shorter than `shortest`, and false
/// after 200 steps. The type Problem has these members:
///
///     double sum_of_squares()               the sum at the present point
///     double try_step(double damping)       computes a Gauss-Newton step, with the diagonal of the normal
///                                           matrix multiplied by 1 + damping; returns the length of the step
///     double tried_sum_of_squares()         the sum after the step of try_step()
///     void take_step()                      moves the point by the step of try_step()
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
