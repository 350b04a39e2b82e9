#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "tests/engine/kinds/sobol/shapley_coverage.h"
#include "tests/engine/stats/effect_coverage.h"

// The coverage of intervals in engine/THEORY.md, by the code of the tests and with more repetitions:
// coverage_table [REPETITIONS].

namespace {

using namespace poesy;
using namespace poesy::test;

void print_indices(const EffectFunction& function, int repetitions) {
  for (const std::size_t samples : {256U, 1024U, 4096U, 16384U}) {
    const auto indices = index_coverage(function, samples, repetitions, 200 + samples);
    const auto curves = curve_coverage(function, samples, (repetitions + 9) / 10, 300 + samples);
    for (std::size_t p = 0; p < indices.size(); ++p) {
      fmt::print("{:10} n = {:5}  S1 = {:.4f}: index {:.1f} % (above {:.1f}, below {:.1f}), curve {:.1f} %\n",
                 function.name, samples, function.first_order[p], 100.0 * indices[p].share(),
                 100.0 * indices[p].too_high(), 100.0 * indices[p].too_low(), 100.0 * curves[p].share());
    }
  }
}

void print_poses(int repetitions) {
  for (const std::size_t samples : {256U, 1024U, 4096U, 16384U}) {
    fmt::print("four poses n = {:5}: independent {:.1f} %, the same machines {:.1f} %\n", samples,
               100.0 * aggregated_coverage(Dependence::independent, samples, repetitions, 400).share(),
               100.0 * aggregated_coverage(Dependence::unknown, samples, repetitions, 500).share());
  }
}

void print_gradients(int repetitions) {
  for (const double limit : {0.45, 0.35, 0.3, 0.1}) {
    for (const std::size_t machines : {500U, 1000U, 2000U, 5000U, 20000U}) {
      const double good = std::erf(limit / std::sqrt(0.06));
      fmt::print("yield {:.4f}, {:5} machines, {:7.1f} rejects: gradient {:.1f} %\n", good, machines,
                 (1.0 - good) * static_cast<double>(machines),
                 100.0 * gradient_coverage(limit, machines, repetitions, 600).share());
    }
  }
}

void print_shapley(int repetitions) {
  for (const ShapleyFunction& function : shapley_functions()) {
    for (const std::size_t samples : {256U, 1024U}) {
      const auto coverage = shapley_coverage(function, samples, repetitions, 1000 * samples);
      const auto effects = function.effects();
      for (std::size_t p = 0; p < coverage.size(); ++p) {
        fmt::print("{:10} n = {:5}  Shapley effect {:.4f}: {:.1f} % (above {:.1f}, below {:.1f})\n", function.name,
                   samples, effects[p], 100.0 * coverage[p].share(), 100.0 * coverage[p].too_high(),
                   100.0 * coverage[p].too_low());
      }
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  const int repetitions = count > 1 ? std::atoi(arguments[1]) : 10000;
  const std::vector<EffectFunction> functions{linear({.8, .15, .05, 0.0}),
                                              linear({.99, .01}),
                                              linear({1.0}),
                                              ishigami(),
                                              folded(),
                                              exponential(0.5, {.7, .25, .05}),
                                              exponential(1.0, {.7, .25, .05})};
  print_shapley(repetitions);
  for (const EffectFunction& function : functions) print_indices(function, repetitions);
  print_poses(repetitions);
  print_gradients(repetitions);
  return 0;
}
