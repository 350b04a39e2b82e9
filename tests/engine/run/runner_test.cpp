#include "engine/kinds/sensitivity/kind.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/evaluation.h"
#include "engine/run/run_options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/run/evaluate_unit.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"

namespace poesy {
namespace {

const Catalog& catalog() {
  static const Catalog fake = test::fake_catalog();
  return fake;
}

Study study_of(std::size_t poses, std::size_t samples) {
  const Distribution normal = Distribution::normal(1e-3);
  Study study;
  study.mechanism = {&catalog().front(), {test::FakeModel::kArm}, 0, {}};
  study.errors.by_factor = {normal, normal, normal};
  study.poses.count = poses;
  study.poses.workspace = {{-0.3, -0.2}, {-0.1, 0.1}, {-0.1, 0.1}};
  study.analysis.kind = &sensitivity::kStudy;
  study.analysis.factors = {FactorIndex(0), FactorIndex(2), FactorIndex(1)};
  study.analysis.samples = samples;
  study.seed = 3;
  return study;
}

struct Prepared {
  explicit Prepared(const Study& study)
      : model(build_model(study.mechanism)), plan(study, select_poses(study.poses, *model).poses) {}
  std::unique_ptr<Model> model;
  Plan plan;
};

sensitivity::Result run(const Study& study, std::size_t threads) {
  const Prepared prepared(study);
  RunOptions options;
  options.threads = threads;
  return sensitivity::run_sensitivity(prepared.plan, *prepared.model, 0.95, options).value();
}

TEST(RunSensitivity, HasTheSameBitsForAnyNumberOfThreads) {
  const Study study = study_of(5, 3 * Plan::kUnitSamples + 17);
  const sensitivity::Result one = run(study, 1);
  for (const std::size_t threads : {1u, 2u, 3u, 7u}) {
    const sensitivity::Result many = run(study, threads);
    EXPECT_EQ(many.global, one.global);
    EXPECT_EQ(many.local, one.local);
    EXPECT_EQ(many.mean, one.mean);
    EXPECT_EQ(many.background, one.background);
    EXPECT_EQ(many.local_ci_low, one.local_ci_low);
    EXPECT_EQ(many.global_ci_high, one.global_ci_high);
  }
}

TEST(RunSensitivity, FindsTheKnownIndices) {
  // For a normal error e with standard deviation sigma, |w e| has the standard deviation |w| sigma sqrt(1 - 2/pi).
  const Study study = study_of(4, 20000);
  const sensitivity::Result result = run(study, 2);
  const Prepared prepared(study);
  const double folded = std::sqrt(1.0 - 2.0 / std::numbers::pi);
  // The relative standard error of a standard deviation is sqrt((kurtosis - 1) / (4 n)); the kurtosis of a folded
  // normal is 3.87. For 24 comparisons and alpha = 0.001 in all, 4.1 standard errors are allowed.
  const double tolerance = 4.1 * std::sqrt((3.87 - 1.0) / (4.0 * 20000.0));
  for (std::size_t r = 0; r < result.responses(); ++r) {
    for (std::size_t p = 0; p < result.factors(); ++p) {
      for (std::size_t m = 0; m < result.poses(); ++m) {
        const std::size_t factor = study.analysis.factors[p].value;
        const double truth = folded * std::abs(test::FakeModel::weight(test::FakeModel::kArm, r, factor,
                                                                       prepared.plan.poses()[PoseIndex(m)]));
        EXPECT_NEAR(result.local(r, p, m), truth, tolerance * truth);
      }
    }
  }
}

TEST(RunSensitivity, CountsEverySample) {
  const sensitivity::Result result = run(study_of(3, 2500), 2);
  EXPECT_EQ(result.total().total(), 3u * 3u * 2500u);
  for (const std::uint64_t count : result.count) EXPECT_EQ(count, 2500u);
}

TEST(RunSensitivity, FirstSamplesAreTheSameInALongerStudy) {
  const Prepared shorter(study_of(2, Plan::kUnitSamples));
  const Prepared longer(study_of(2, 2 * Plan::kUnitSamples));
  UnitEvaluator evaluate_shorter(shorter.plan, *shorter.model);
  UnitEvaluator evaluate_longer(longer.plan, *longer.model);
  for (std::size_t u = 0; u < shorter.plan.units(); ++u) {
    const UnitStats a = evaluate_shorter(shorter.plan.unit(u));
    const UnitStats b = evaluate_longer(longer.plan.unit(2 * u));
    ASSERT_EQ(longer.plan.unit(2 * u).first, SampleIndex(0));
    for (std::size_t r = 0; r < a.responses.size(); ++r) {
      EXPECT_EQ(a.responses[r].mean(), b.responses[r].mean());
      EXPECT_EQ(a.responses[r].standard_deviation(), b.responses[r].standard_deviation());
    }
  }
}

TEST(RunSensitivity, StopsWhenAsked) {
  const Prepared prepared(study_of(50, 100000));
  std::atomic<bool> stop{false};
  std::uint64_t reported = 0;
  RunOptions options;
  options.threads = 2;
  options.stop = &stop;
  options.progress = [&](const Progress& progress) {
    reported = progress.solves;
    stop = true;
  };
  EXPECT_FALSE(sensitivity::run_sensitivity(prepared.plan, *prepared.model, 0.95, options));
  EXPECT_LT(reported, prepared.plan.solves() / 10);
}

TEST(RunEvaluation, PairsRowsWithPoses) {
  const std::unique_ptr<Model> model = build_model(study_of(1, 2).mechanism);
  const PoseSet poses(3, {-0.2, 0.1, 0.0, -0.3, 0.0, 0.2});
  const ErrorTable errors{{FactorIndex(1)}, {1e-3, -2e-3}, 2};
  const auto paired = run_evaluation(*model, {}, poses, errors, Pairing::row_by_row, {}).value();
  const auto crossed = run_evaluation(*model, {}, poses, errors, Pairing::every_pose_with_every_row, {}).value();
  EXPECT_EQ(paired.samples(), 1u);
  EXPECT_EQ(crossed.samples(), 2u);
  for (std::size_t m = 0; m < 2; ++m) {
    for (std::size_t s = 0; s < 2; ++s) {
      const double sum = test::FakeModel::weight(test::FakeModel::kArm, 1, 1, poses[PoseIndex(m)]) * errors.values[s];
      EXPECT_EQ(crossed.response(1, m, s), std::abs(sum));
      EXPECT_EQ(crossed.detail(m, s, 1), sum);
      if (s == m) {
        EXPECT_EQ(paired.response(1, m, 0), std::abs(sum));
      }
    }
  }
}

}  // namespace
}  // namespace poesy
