#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "engine/kinds/sensitivity/fidelity.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/kinds/sensitivity/result.h"
#include "tests/support/kinds.h"
#include "tests/support/two_fidelities_model.h"

namespace poesy::sensitivity {
namespace {

using Model = test::TwoFidelitiesModel;
using Verdicts = Array<std::uint8_t, axis::Factor>;

/// Compares both fidelities on the same draws. sigma: standard deviation of every error.
FidelityResult compared(double sigma, std::size_t samples) {
  const Catalog catalog = test::two_fidelities_catalog();
  Study study;
  study.mechanism = {&catalog.front(), {Model::kArm}, 0, {}, 1};
  study.errors.by_factor.assign(3, Distribution::normal(sigma));
  study.analysis.kind = &kStudy;
  study.analysis.factors = {FactorIndex(0), FactorIndex(1), FactorIndex(2)};
  study.analysis.samples = samples;
  study.seed = 17;
  const Plan plan(study, PoseSet(3, {-0.2, 0.0, 0.0, -0.25, 0.1, 0.1}));
  const auto run = [&](const MechanismChoice& choice) {
    return *run_sensitivity(plan, *build_model(choice), 0.95, {2, {}, nullptr});
  };
  const std::array dimensions{Dimension::length};
  const std::vector<double> sigmas(3, sigma);
  return compare_fidelities(run(study.mechanism), run(at_compared_fidelity(study.mechanism)), dimensions, sigmas, 0.01);
}

// The exact fidelity shifts the mean by bend sigma^2. The sampling error of this shift over both poses is sqrt(1 /
// samples) of it; the test allows five of them (alpha = 6e-7). The change of the standard deviation adds less than
// 1e-3.
TEST(FidelityOfAQuadraticModel, HasItsClosedForm) {
  constexpr std::size_t kSamples = 200'000;
  const double tolerance = 5.0 / std::sqrt(double{kSamples}) + 1e-3;
  const double sigma = 0.02;
  const FidelityResult found = compared(sigma, kSamples);
  for (std::size_t p = 0; p < 2; ++p) {
    const double weight = Model::kWeights[p];
    const double spread = std::sqrt(weight * weight + 2.0 * Model::kBend * Model::kBend * sigma * sigma);
    const double expected = std::hypot(Model::kBend * sigma, spread - weight) / spread;
    EXPECT_NEAR(found.nonlinearity(0, p) / expected, 1.0, tolerance) << p;
    // The index changes much less than the mean.
    EXPECT_LT(std::abs(found.relative_discrepancy(0, p)), 0.1 * expected);
  }
  EXPECT_TRUE(std::isnan(found.nonlinearity(0, 2)));
}

// An error counts as linear while bend sigma / weight is below 1 %: up to sigma = 0.04 for delta_1 and 0.02 for
// epsilon_1.
TEST(FidelityOfAQuadraticModel, VerdictsTurnWithTheSize) {
  EXPECT_EQ(compared(0.015, 20'000).linear, Verdicts({3}, {1, 1, 1}));
  EXPECT_EQ(compared(0.025, 20'000).linear, Verdicts({3}, {1, 0, 1}));
  EXPECT_EQ(compared(0.060, 20'000).linear, Verdicts({3}, {0, 0, 1}));
}

}  // namespace
}  // namespace poesy::sensitivity
