#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/optimise/least_cost.h"

/// Random convex allocation problems. reference_costs.py generates the same ones.
namespace poesy::testing {

/// The random generator SplitMix64 of Steele, Lea and Flood.
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t state) : state_(state) {}

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }
  /// A whole number below n.
  std::uint64_t below(std::uint64_t n) { return next() % n; }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

 private:
  std::uint64_t state_;
};

/// A cost law with its parameters, so that a test can compute the cost itself.
struct PlainLaw {
  int form;  ///< 0: fixed + b / T^shape; 1: fixed + b exp(-T / shape)
  double fixed;
  double b;
  double shape;

  CostLaw law() const {
    if (form == 1) return CostLaw::exponential(fixed, b, shape);
    return shape == 1.0 ? CostLaw::reciprocal(fixed, b) : CostLaw::reciprocal_power(fixed, b, shape);
  }
  /// The cost in long double, with more digits than the engine has.
  long double at(long double tolerance) const {
    const long double part =
        form == 1 ? std::exp(-tolerance / shape) : std::pow(tolerance, -static_cast<long double>(shape));
    return fixed + b * part;
  }
};

struct RandomProgramme {
  AllocationProblem problem;
  std::vector<PlainLaw> laws;  ///< [parts]
};

inline PlainLaw random_law(SplitMix& draw, double t0) {
  const std::uint64_t kind = draw.below(3);
  const double fixed = draw.uniform();
  const double height = 0.2 + 2.0 * draw.uniform();
  const double bend = draw.uniform();
  if (kind == 0) return {0, fixed, height * t0, 1.0};
  if (kind == 1) return {0, fixed, height * std::pow(t0, 0.5 + 2.0 * bend), 0.5 + 2.0 * bend};
  return {1, fixed, 2.0 * height, t0 * (0.3 + 2.0 * bend)};
}

/// The random problem with this number. It has 2 to 12 parts and 1 to 10 limits, with all cost laws. Some limits are
/// repeated, some parts are fixed, and some have no upper bound or no effect.
inline RandomProgramme random_programme(std::uint64_t number) {
  SplitMix draw(number * 1000003);
  RandomProgramme random;
  ToleranceLimits& limits = random.problem.limits;
  limits.parts = 2 + draw.below(11);
  const std::uint64_t count = 1 + draw.below(10);
  limits.stacking = draw.below(2) == 1 ? Stacking::worst_case : Stacking::root_sum_square;
  std::vector<double> t0;
  for (std::size_t i = 0; i < limits.parts; ++i) {
    t0.push_back(0.01 + 0.09 * draw.uniform());
    random.laws.push_back(random_law(draw, t0[i]));
    double lo = t0[i] * (0.02 + 0.3 * draw.uniform());
    double hi = t0[i] * (1.0 + 3.0 * draw.uniform());
    const std::uint64_t special = draw.below(8);
    if (special == 0) lo = hi = t0[i];
    if (special == 1 || special == 2) hi = std::numeric_limits<double>::infinity();
    random.problem.parts.push_back({{random.laws[i].law(), lo, hi}});
  }
  for (std::size_t l = 0; l < count; ++l) {
    const bool again = draw.below(6) == 0 && l > 0;
    double room = 0.0;
    const double width = 0.05 + draw.uniform();
    for (std::size_t i = 0; i < limits.parts; ++i) {
      const bool none = draw.below(5) == 0;
      double effect = (0.1 + draw.uniform()) * draw.uniform() / size_of(t0[i], limits.stacking);
      if (none) effect = 0.0;
      if (again) effect = limits.effects[(l - 1) * limits.parts + i];
      limits.effects.push_back(effect);
      room +=
          effect * (size_of(random.problem.parts[i][0].lo, limits.stacking) + width * size_of(t0[i], limits.stacking));
    }
    limits.room.push_back(std::max(room, 1e-3));
  }
  for (std::size_t i = 0; i < limits.parts; ++i) {
    double effect = 0.0;
    for (std::size_t l = 0; l < count; ++l) effect += limits.row(l)[i];
    Process& process = random.problem.parts[i][0];
    if (effect == 0.0) process.hi = std::min(process.hi, 3.0 * t0[i]);
  }
  return random;
}

}  // namespace poesy::testing
