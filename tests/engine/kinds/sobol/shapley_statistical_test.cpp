// Coverage of the intervals of Shapley effects, by simulation.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/engine/kinds/sobol/shapley_coverage.h"

namespace poesy::test {
namespace {

class ShapleyIntervals : public ::testing::TestWithParam<std::size_t> {};

// The coverage may differ from 95 % by 1.5 percentage points plus 3.3 standard errors of the simulation (alpha = 0.1 %
// for each of nine intervals).
TEST_P(ShapleyIntervals, HoldTheEffectAsTheySay) {
  constexpr int kRepetitions = 1000;
  const double allowed = 0.015 + 3.3 * std::sqrt(0.95 * 0.05 / kRepetitions);
  for (const ShapleyFunction& function : shapley_functions()) {
    const auto coverage = shapley_coverage(function, GetParam(), kRepetitions, 1);
    for (std::size_t p = 0; p < coverage.size(); ++p) {
      EXPECT_NEAR(coverage[p].share(), 0.95, allowed) << function.name << " error " << p;
      RecordProperty(function.name + "_" + std::to_string(p), std::to_string(coverage[p].share()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, ShapleyIntervals, ::testing::Values(256, 1024));

TEST(ShapleyFunctions, HaveTheEffectsOfTheReference) {
  const auto functions = shapley_functions();
  const auto linear = functions[0].effects();
  EXPECT_NEAR(linear[0], 0.10416667, 5e-9);
  EXPECT_NEAR(linear[1], 0.41822917, 5e-9);
  EXPECT_NEAR(linear[2], 0.47760417, 5e-9);
  // y = |sqrt(0.8) z1 + sqrt(0.2) z2|: z1 explains 0.8 of the variance of the sum, and z2 explains 0.2.
  EXPECT_NEAR(functions[1].explained(0.8) / functions[1].explained(1.0), 0.59887592, 5e-9);
  EXPECT_NEAR(functions[1].explained(0.2) / functions[1].explained(1.0), 0.03515699, 5e-9);
  for (const ShapleyFunction& function : functions) {
    const auto effects = function.effects();
    EXPECT_NEAR(effects[0] + effects[1] + effects[2], 1.0, 1e-14) << function.name;
  }
}

}  // namespace
}  // namespace poesy::test
