#include "engine/drawing/axis_in_disc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace poesy::drawing {
namespace {

using std::numbers::pi;

/// The probability that two uniform points of the unit disc are closer than s (MathWorld, Disk Line Picking). For small
/// s, the closed form loses digits by cancellation; a series is used there, whose relative error is below 1e-12.
double share_below(double s) {
  constexpr double kSmall = 0.003;
  const double square = s * s;
  if (s < kSmall) return square * (1.0 - 4.0 / (3.0 * pi) * s + square * s / (30.0 * pi));
  return 1.0 + 2.0 / pi * (square - 1.0) * std::acos(0.5 * s) -
         s / pi * (1.0 + 0.5 * square) * std::sqrt(1.0 - 0.25 * square);
}

double density_at(double s) {
  return 4.0 * s / pi * std::acos(0.5 * s) - 2.0 * s * s / pi * std::sqrt(1.0 - 0.25 * s * s);
}

/// The root of an increasing function between `low` and `high`, by Newton's method. A Newton step that leaves the
/// bracket is replaced by a bisection step.
template <class F, class Slope>
double root(const F& f, const Slope& slope, double start, double low, double high) {
  constexpr int kMostSteps = 100;
  constexpr double kSame = 4e-16;
  double x = start;
  for (int step = 0; step < kMostSteps; ++step) {
    const double value = f(x);
    (value < 0.0 ? low : high) = x;
    const double newton = x - value / slope(x);
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    const bool is_same = std::abs(next - x) <= kSame * std::abs(next);
    x = next;
    if (is_same) break;
  }
  return x;
}

}  // namespace

double distance_at_share(double u, double most) {
  const double share = u * share_below(most);
  return root([&](double s) { return share_below(s) - share; }, density_at, most * std::sqrt(u), 0.0, most);
}

double chord_at_share(double u, double distance) {
  const double most = std::sqrt(std::max(0.0, (1.0 - 0.5 * distance) * (1.0 + 0.5 * distance)));
  const auto half_width = [](double e) { return std::sqrt((1.0 - e) * (1.0 + e)); };
  const auto area = [&](double e) { return e * half_width(e) + std::asin(e) - distance * e; };
  const auto slope = [&](double e) { return 2.0 * half_width(e) - distance; };
  const double share = std::abs(2.0 * u - 1.0) * area(most);
  const double found =
      root([&](double e) { return area(e) - share; }, slope, std::abs(2.0 * u - 1.0) * most, 0.0, most);
  return std::copysign(found, u - 0.5);
}

}  // namespace poesy::drawing
