#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/engine/stats/coverage.h"
#include "tests/engine/stats/effect_functions.h"
#include "tests/engine/stats/yield_cases.h"

// Repeated experiments: the coverage of 95 % intervals of first-order indices, main effects and gradients of a yield.

namespace poesy::test {

/// For each error, the coverage of the interval of its first-order index.
inline std::vector<Coverage> index_coverage(const EffectFunction& function, std::size_t samples, int repetitions,
                                            std::uint64_t seed) {
  EffectExperiment experiment(seed);
  const BinSpread spread = spread_of(function.distribution);
  std::vector<Coverage> coverage(function.errors());
  for (int r = 0; r < repetitions; ++r) {
    const MainEffectSums sums = experiment.sums(function, samples);
    for (std::size_t p = 0; p < coverage.size(); ++p) {
      const BinnedVariance variance = sums.variance(0, p, spread);
      coverage[p].add(first_order_index(std::span(&variance, 1), Dependence::independent, 0.95).interval,
                      function.first_order[p]);
    }
  }
  return coverage;
}

/// For each error, the coverage of the intervals in all bins of its main-effect curve.
inline std::vector<Coverage> curve_coverage(const EffectFunction& function, std::size_t samples, int repetitions,
                                            std::uint64_t seed) {
  EffectExperiment experiment(seed);
  std::vector<std::array<double, kEffectBins>> truth;
  for (std::size_t p = 0; p < function.errors(); ++p) truth.push_back(bin_means(function, p));
  std::vector<Coverage> coverage(function.errors());
  for (int r = 0; r < repetitions; ++r) {
    const MainEffectSums sums = experiment.sums(function, samples);
    for (std::size_t p = 0; p < coverage.size(); ++p) {
      const auto curve = sums.curve(0, p, 0.95);
      for (std::size_t b = 0; b < kEffectBins; ++b) coverage[p].add(curve[b].interval, truth[p][b]);
    }
  }
  return coverage;
}

/// Responses to two errors at four poses: linear with different shares at three poses, folded at the fourth.
struct FourPoses {
  std::vector<EffectFunction> functions{linear({.8, .2}), linear({.5, .5}), linear({.2, .8}), folded()};
  double aggregated() const {
    const double folded = 1.0 - 2.0 / std::numbers::pi;
    return (.8 + .5 + .2 + folded * functions[3].first_order[0]) / (3.0 + folded);
  }
};

inline Coverage aggregated_coverage(Dependence dependence, std::size_t samples, int repetitions, std::uint64_t seed) {
  EffectExperiment experiment(seed);
  const FourPoses poses;
  const BinSpread spread = spread_of(poses.functions[0].distribution);
  Coverage coverage;
  for (int n = 0; n < repetitions; ++n) {
    std::vector<BinnedVariance> parts;
    if (dependence == Dependence::unknown) {
      const MainEffectSums sums = experiment.sums(poses.functions, samples);
      for (std::size_t r = 0; r < poses.functions.size(); ++r) parts.push_back(sums.variance(r, 0, spread));
    } else {
      for (const EffectFunction& pose : poses.functions) {
        parts.push_back(experiment.sums(pose, samples).variance(0, 0, spread));
      }
    }
    coverage.add(first_order_index(parts, dependence, 0.95).interval, poses.aggregated());
  }
  return coverage;
}

/// The coverage of the intervals of a yield's derivatives by all errors together.
inline Coverage gradient_coverage(const YieldCase& yield, std::size_t machines, int repetitions, std::uint64_t seed) {
  boost::random::mt19937_64 engine(seed);
  Coverage coverage;
  for (int r = 0; r < repetitions; ++r) {
    const std::vector<Estimate> gradient = yield.estimate(machines, 0.95, engine);
    for (std::size_t p = 0; p < gradient.size(); ++p) coverage.add(gradient[p].interval, yield.gradient[p]);
  }
  return coverage;
}

/// slope x standard deviation of three errors.
inline constexpr std::array kThreeErrors{0.1, 0.1, 0.1};

}  // namespace poesy::test
