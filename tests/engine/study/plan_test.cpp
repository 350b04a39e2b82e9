#include "engine/study/plan.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "engine/study/study_kind.h"
#include "tests/support/fake_model.h"

namespace poesy {
namespace {

constexpr StudyKind kOneByOne{
    .name = "one by one", .asks = "", .keys = {}, .varies = Varies::one_by_one, .at_pose = {}};
constexpr StudyKind kTogether{.name = "together", .asks = "", .keys = {}, .varies = Varies::together, .at_pose = {}};

/// A study of the errors 2 and 0 of the fake mechanism, in this order. Each error has a different distribution.
Study study_with(const CatalogEntry& entry, std::size_t samples) {
  Study study;
  study.mechanism.entry = &entry;
  for (const double sigma : {1e-3, 2e-3, 3e-3}) study.errors.by_factor.push_back(Distribution::normal(sigma));
  study.analysis.kind = &kOneByOne;
  study.analysis.factors = {FactorIndex(2), FactorIndex(0)};
  study.analysis.samples = samples;
  study.analysis.background = Background{{FactorIndex(1), FactorIndex(2)}, 1e-3, 2e-2};
  study.seed = 7;
  return study;
}

PoseSet some_poses(std::size_t count) { return PoseSet(3, std::vector<double>(3 * count, -0.2)); }

class PlanOfSize : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {};

TEST_P(PlanOfSize, CoversEverySampleOnceInOrder) {
  const auto [poses, samples] = GetParam();
  const Catalog catalog = test::fake_catalog();
  const Plan plan(study_with(catalog[0], samples), some_poses(poses));
  std::tuple<std::size_t, std::size_t, std::size_t> expected{0, 0, 0};
  for (std::size_t u = 0; u < plan.units(); ++u) {
    const WorkUnit unit = plan.unit(u);
    ASSERT_EQ(std::tuple(unit.slot, unit.pose.value, unit.first.value), expected) << "unit " << u;
    ASSERT_GE(unit.count, 1u);
    ASSERT_LE(unit.count, Plan::kUnitSamples);
    auto& [slot, pose, sample] = expected;
    sample += unit.count;
    ASSERT_LE(sample, samples);
    if (sample < samples) continue;
    sample = 0;
    if (++pose < poses) continue;
    pose = 0;
    ++slot;
  }
  EXPECT_EQ(expected, std::tuple(std::size_t{2}, std::size_t{0}, std::size_t{0}));
  EXPECT_EQ(plan.solves(), 2 * poses * samples);
}

INSTANTIATE_TEST_SUITE_P(Sizes, PlanOfSize,
                         testing::Combine(testing::Values(1, 2, 7), testing::Values(2, 999, 1000, 1001, 2500)),
                         [](const auto& size) {
                           return std::to_string(std::get<0>(size.param)) + "_poses_" +
                                  std::to_string(std::get<1>(size.param)) + "_samples";
                         });

TEST(Plan, HasOneSlotWhereAllErrorsVaryTogether) {
  const Catalog catalog = test::fake_catalog();
  Study study = study_with(catalog[0], 2500);
  study.analysis.kind = &kTogether;
  const Plan plan(study, some_poses(4));
  EXPECT_EQ(plan.slots(), 1u);
  EXPECT_EQ(plan.factors().size(), 2u);
  EXPECT_EQ(plan.solves(), 4u * 2500u);
  ASSERT_EQ(plan.units(), 4u * 3u);
  for (std::size_t u = 0; u < plan.units(); ++u) {
    const WorkUnit unit = plan.unit(u);
    EXPECT_EQ(unit.slot, 0u);
    EXPECT_EQ(unit.pose.value, u / 3);
    EXPECT_EQ(unit.first.value, u % 3 * Plan::kUnitSamples);
  }
}

TEST(Plan, HasNoUnitsWithoutPoses) {
  const Catalog catalog = test::fake_catalog();
  const Plan plan(study_with(catalog[0], 10), PoseSet());
  EXPECT_EQ(plan.units(), 0u);
  EXPECT_EQ(plan.solves(), 0u);
}

TEST(Plan, CountsSolvesBeyond32Bits) {
  const Catalog catalog = test::fake_catalog();
  const Plan plan(study_with(catalog[0], 500'000'000'000), some_poses(1000));
  EXPECT_EQ(plan.solves(), 1'000'000'000'000'000u);
  EXPECT_EQ(plan.unit(plan.units() - 1).first.value, 500'000'000'000u - Plan::kUnitSamples);
}

TEST(Plan, TakesDistributionsBySlotAndBackgroundOfWhatDoesNotVary) {
  const Catalog catalog = test::fake_catalog();
  const Plan plan(study_with(catalog[0], 10), some_poses(1));
  ASSERT_EQ(plan.distributions().size(), 2u);
  EXPECT_EQ(plan.distributions()[0].sigma(), 3e-3);
  EXPECT_EQ(plan.distributions()[1].sigma(), 1e-3);
  const std::vector<double> background(plan.background().begin(), plan.background().end());
  EXPECT_EQ(background, (std::vector<double>{0.0, 2e-2, 0.0}));
  EXPECT_EQ(plan.seed(), 7u);
}

}  // namespace
}  // namespace poesy
