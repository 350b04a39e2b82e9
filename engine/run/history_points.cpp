#include "engine/run/history_points.h"

namespace poesy {

std::vector<std::size_t> history_points(const Plan& plan) {
  std::vector<std::size_t> points;
  if (plan.adaptive()) return points;
  for (std::size_t left = plan.samples() / 100, decade = 100; left > 0; left /= 10, decade *= 10) {
    for (const std::size_t step : {1U, 2U, 5U}) {
      if (step <= left) points.push_back(step * decade);
    }
  }
  return points;
}

}  // namespace poesy
