#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "tests/engine/kinds/sobol/shapley_coverage.h"
#include "tests/engine/stats/effect_coverage.h"

// Measures the coverage of the intervals that engine/docs/theory.md states, by the code of the tests but with more
// repetitions. Usage: coverage_table [REPETITIONS], by default 10000.

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

/// Prints the coverage of the intervals of yield gradients for several numbers of machines. shape: name of the errors'
/// distribution. good: the true yield.
void print_gradients(const char* shape, double good, const YieldCase& yield, int repetitions) {
  for (const std::size_t machines : {250U, 500U, 1000U, 2000U, 5000U, 20000U}) {
    fmt::print("{}, yield {:.4f}, {:5} machines, {:7.1f} rejects: gradient {:.1f} %\n", shape, good, machines,
               (1.0 - good) * static_cast<double>(machines),
               100.0 * gradient_coverage(yield, machines, repetitions, 600).share());
  }
}

void print_gradients(int repetitions) {
  const std::vector<double> uniform(3, 0.1 * std::numbers::sqrt3);
  const std::vector<double> triangular(6, 0.1 * std::sqrt(1.5));
  for (const double limit : {0.45, 0.4, 0.35, 0.3, 0.1}) {
    print_gradients("normal", std::erf(limit / std::sqrt(0.06)), normal_case(kThreeErrors, limit), repetitions);
    print_gradients("uniform", share_of_uniforms(uniform, limit), uniform_case(kThreeErrors, limit), repetitions);
    print_gradients("triangular", share_of_uniforms(triangular, limit), triangular_case(kThreeErrors, limit),
                    repetitions);
  }
  for (const double correlation : {0.3, 0.6, 0.9}) {
    for (const double z : {2.6, 2.0, 1.0}) {
      const double limit = z * 0.1 * std::sqrt(3.0 + 6.0 * correlation);
      print_gradients("correlated", std::erf(z / std::numbers::sqrt2), correlated_case(0.1, correlation, limit),
                      repetitions);
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
