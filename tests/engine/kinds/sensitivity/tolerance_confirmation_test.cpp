#include <gtest/gtest.h>

#include <cmath>

#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/study/poses/pose_selection.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"

/// Computes tolerances within a limit from a sensitivity study, and confirms them with a Monte Carlo study. The
/// response of the fake mechanism is |sum of w_p e_p|, so the prediction is exact except for its sampling error.
namespace poesy::sensitivity {
namespace {

constexpr std::size_t kPoses = 6;
constexpr std::size_t kSamples = 20000;
constexpr std::size_t kResponse = 1;

const Catalog& catalog() {
  static const Catalog fake = test::fake_catalog();
  return fake;
}

/// A study that varies one error with an effect and one without. Another error with an effect is constant: the
/// background (m).
Study study_with(double background) {
  Study study;
  study.mechanism = {&catalog().front(), {test::FakeModel::kArm}, 0, {}};
  study.errors.by_factor = {Distribution::normal(1e-3), Distribution::uniform(2e-3), Distribution::normal(1e-3)};
  study.poses.count = kPoses;
  study.poses.workspace = {{-0.3, -0.2}, {-0.1, 0.1}, {-0.1, 0.1}};
  study.analysis.kind = &kStudy;
  study.analysis.factors = {FactorIndex(1), FactorIndex(2)};
  study.analysis.samples = kSamples;
  study.analysis.background = Background{{FactorIndex(0)}, background, 0.0};
  study.seed = 11;
  return study;
}

/// A sensitivity study with its result.
struct Found {
  explicit Found(Study given)
      : study(std::move(given)),
        plan(study, select_poses(study.poses, model).poses),
        result(run_sensitivity(plan, model, 0.95, {}).value()) {
    for (const Distribution& distribution : plan.distributions()) sigma.push_back(distribution.standard_deviation());
  }

  ResponseStudy response() const { return response_study(result, sigma, {}, kResponse); }
  double weight(std::size_t factor, std::size_t pose) const {
    return test::FakeModel::weight(test::FakeModel::kArm, kResponse, factor, plan.poses()[PoseIndex(pose)]);
  }

  test::FakeModel model;
  Study study;
  Plan plan;
  Result result;
  std::vector<double> sigma;
};

TEST(ToleranceConfirmation, BackgroundActsAlone) {
  const Found found(study_with(2e-3));
  ASSERT_EQ(found.result.background.size(), 2 * kPoses);
  for (std::size_t m = 0; m < kPoses; ++m) {
    EXPECT_DOUBLE_EQ(found.result.background(kResponse, m), std::abs(found.weight(0, m)) * 2e-3);
  }
}

TEST(ToleranceConfirmation, BackgroundHasNoVariedErrors) {
  Study study = study_with(2e-3);
  study.analysis.background->factors = {FactorIndex(1)};
  study.analysis.background->angular = 1e-3;
  for (const double value : Found(study).result.background) EXPECT_EQ(value, 0.0);
}

TEST(ToleranceConfirmation, MonteCarloConfirmsTheLimit) {
  // Two-sided normal quantile for alpha = 0.001, divided by the four comparisons of this test.
  constexpr double kZ = 3.66;
  for (const double background : {0.0, 2e-4}) {
    Found found(study_with(background));
    const MeanSquare prediction = mean_square(found.response());
    const double limit = 3e-4;
    const LimitTolerances tolerances =
        limit_tolerances(found.response(), prediction, found.sigma, limit, std::vector(found.sigma.size(), HUGE_VAL));
    for (const auto* chosen : {&tolerances.equal_effect, &tolerances.equal_tolerance}) {
      Study confirmation = found.study;
      confirmation.analysis.kind = &monte_carlo::kStudy;
      confirmation.errors.by_factor[1] = Distribution::normal((*chosen)[0]);
      confirmation.seed = 12;
      const Plan plan(confirmation, found.plan.poses());
      const auto confirmed = monte_carlo::run_monte_carlo(plan, found.model, confirmation.analysis, {}).value();
      const double mean = confirmed.overall_mean(kResponse);
      const double square = mean * mean + std::pow(confirmed.overall_std(kResponse), 2);
      EXPECT_LT(mean, limit);
      // A squared response at a pose is (b + w t z)^2, with the background's effect b, the weight w, the tolerance t
      // and a standard normal z. Its variance is 2 (w t)^4 + 4 (b w t)^2. The factor 2 below is for the prediction,
      // which has as many samples of a uniform error, whose squares vary less.
      double variance = 0.0;
      for (std::size_t m = 0; m < kPoses; ++m) {
        const double spread2 = std::pow(found.weight(1, m) * (*chosen)[0], 2);
        const double constant2 = std::pow(found.weight(0, m) * background, 2);
        variance += 2.0 * (2.0 * spread2 * spread2 + 4.0 * constant2 * spread2);
      }
      const double standard_error = std::sqrt(variance / static_cast<double>(kSamples)) / static_cast<double>(kPoses);
      EXPECT_NEAR(square, limit * limit, kZ * standard_error) << "background " << background;
      EXPECT_LT(kZ * standard_error, 0.05 * limit * limit) << "the bound would see nothing";
    }
  }
}

}  // namespace
}  // namespace poesy::sensitivity
