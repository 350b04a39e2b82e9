#include "engine/run/evaluate_unit.h"

#include <gtest/gtest.h>

#include "tests/engine/run/prepared.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"

namespace poesy {
namespace {

using List = std::vector<std::size_t>;

Plan plan_of(std::size_t samples) {
  static const Catalog catalog = test::fake_catalog();
  Study study;
  study.mechanism = {&catalog.front(), {test::FakeModel::kArm}, 0, {}};
  study.errors.by_factor.assign(3, Distribution::normal(1e-3));
  study.poses.count = 1;
  study.poses.workspace = {{-0.3, -0.2}, {-0.1, 0.1}, {-0.1, 0.1}};
  study.analysis.kind = &sensitivity::kStudy;
  study.analysis.factors = {FactorIndex(0)};
  study.analysis.samples = samples;
  return test::Prepared(study).plan;
}

TEST(HistoryPoints, AreOneTwoAndFiveOfEachPowerOfTen) {
  EXPECT_EQ(history_points(plan_of(10000)), (List{100, 200, 500, 1000, 2000, 5000, 10000}));
  EXPECT_EQ(history_points(plan_of(9999)), (List{100, 200, 500, 1000, 2000, 5000}));
  EXPECT_EQ(history_points(plan_of(199)), List{100});
  EXPECT_EQ(history_points(plan_of(99)), List());
}

TEST(HistoryPoints, OfMoreSamplesBeginWithTheSame) {
  const List longest = history_points(plan_of(std::numeric_limits<std::size_t>::max()));
  EXPECT_EQ(longest.back(), 10'000'000'000'000'000'000U);
  EXPECT_TRUE(std::ranges::is_sorted(longest, std::ranges::less_equal()));
  for (const std::size_t samples : {2UL, 500UL, 1300UL, 20000UL, 1'000'000'007UL}) {
    const List points = history_points(plan_of(samples));
    ASSERT_LT(points.size(), longest.size());
    EXPECT_TRUE(std::ranges::equal(points, std::span(longest).first(points.size())));
    EXPECT_GT(longest[points.size()], samples);
  }
}

TEST(HistoryPoints, AboveAUnitAreWholeUnits) {
  for (const std::size_t point : history_points(plan_of(1'000'000'000))) {
    EXPECT_TRUE(point < Plan::kUnitSamples || point % Plan::kUnitSamples == 0) << point;
  }
}

TEST(HistoryPoints, AdaptiveSamplesHaveNone) {
  Study study;
  study.analysis.kind = &sensitivity::kStudy;
  study.analysis.samples = 10000;
  study.analysis.adaptive = AdaptiveSamples{1000, 0.1};
  static const Catalog catalog = test::fake_catalog();
  study.mechanism = {&catalog.front(), {test::FakeModel::kArm}, 0, {}};
  EXPECT_EQ(history_points(Plan(study, PoseSet(3, {-0.2, 0.0, 0.0}))), List());
}

}  // namespace
}  // namespace poesy
