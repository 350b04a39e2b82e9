#include "engine/study/poses/pose_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/random/low_discrepancy.h"
#include "tests/engine/study/region.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/names.h"

namespace poesy {
namespace {

using Select = PoseSelection::Select;

const test::FakeModel kModel;

PoseSelection interior(std::size_t count) { return test::fake_box(Select::interior, count); }

/// Joint q_2 of the fake mechanism is beta + gamma; its condition number is 1 / cos(beta).
PoseSelection limited(Select select, std::size_t count) {
  PoseSelection selection = test::fake_box(select, count);
  selection.limits = {{1, {-0.2, 0.4}, {"study.toml", 13, 21}}};
  selection.max_condition = 1.05;
  return selection;
}

bool keeps_limits(std::span<const double> pose) {
  const double q_2 = pose[1] + pose[2];
  return q_2 >= -0.2 && q_2 <= 0.4 && 1.0 / std::cos(pose[1]) <= 1.05;
}

std::vector<double> values_of(const PoseSet& poses) {
  std::vector<double> values;
  for (std::size_t m = 0; m < poses.size(); ++m) {
    values.insert(values.end(), poses[PoseIndex(m)].begin(), poses[PoseIndex(m)].end());
  }
  return values;
}

TEST(InteriorPoses, LieInsideTheBoxWithoutRepetition) {
  const PoseSelection selection = interior(500);
  const PoseSet poses = select_poses(selection, kModel).poses;
  ASSERT_EQ(poses.size(), 500u);
  ASSERT_EQ(poses.coordinates(), 3u);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<double> column = poses.column(c);
    EXPECT_EQ(std::set<double>(column.begin(), column.end()).size(), 500u);
    for (const double value : column) {
      EXPECT_GT(value, selection.workspace[c].lower);
      EXPECT_LT(value, selection.workspace[c].upper);
    }
  }
}

TEST(InteriorPoses, AreSpreadEvenly) {
  const PoseSet poses = select_poses(interior(64), kModel).poses;
  for (std::size_t c = 0; c < 3; ++c) {
    const Range range = interior(1).workspace[c];
    std::vector<int> in_eighth(8, 0);
    for (const double value : poses.column(c)) {
      ++in_eighth[static_cast<std::size_t>(8.0 * (value - range.lower) / (range.upper - range.lower))];
    }
    for (const int count : in_eighth) EXPECT_NEAR(count, 8, 1) << "coordinate " << c;
  }
}

TEST(InteriorPoses, OfAPlainBoxAreTheSobolPointsBitForBit) {
  const PoseSelection selection = interior(1738);
  const SelectedPoses selected = select_poses(selection, kModel);
  std::vector<double> expected(std::size_t{1738} * 3);
  SobolSequence(3).next(expected);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const Range& range = selection.workspace[k % 3];
    expected[k] = std::lerp(range.lower, range.upper, expected[k]);
  }
  EXPECT_EQ(values_of(selected.poses), expected);
  EXPECT_TRUE(selected.rejected.empty());
}

TEST(InteriorPoses, AreTheFeasibleOnesOfThePlainBoxInOrder) {
  const SelectedPoses selected = select_poses(limited(Select::interior, 200), kModel);
  const PoseSet candidates = select_poses(interior(200 + test::total(selected.rejected)), kModel).poses;
  std::vector<double> expected;
  for (std::size_t m = 0; m < candidates.size(); ++m) {
    const auto pose = candidates[PoseIndex(m)];
    if (keeps_limits(pose)) expected.insert(expected.end(), pose.begin(), pose.end());
  }
  EXPECT_EQ(values_of(selected.poses), expected);
}

TEST(InteriorPoses, RejectedOnesAreCountedMostFrequentFirst) {
  const SelectedPoses selected = select_poses(limited(Select::interior, 500), kModel);
  ASSERT_EQ(selected.rejected.size(), 3u);
  std::set<std::string> reasons;
  for (const RejectedPoses& each : selected.rejected) {
    EXPECT_GT(each.count, 0u);
    reasons.insert(each.reason);
  }
  EXPECT_EQ(reasons, (std::set<std::string>{"q_2 above 22.9183118052 deg", "q_2 below -11.4591559026 deg",
                                            "singular: condition number above 1.05"}));
  EXPECT_GE(selected.rejected[0].count, selected.rejected[1].count);
  EXPECT_GE(selected.rejected[1].count, selected.rejected[2].count);
}

class FewerPoses : public testing::TestWithParam<PoseSelection> {};

TEST_P(FewerPoses, AreTheFirstOfMore) {
  PoseSelection selection = GetParam();
  const SelectedPoses more = select_poses(selection, kModel);
  ASSERT_EQ(more.poses.size(), selection.count);
  const std::vector<double> all = values_of(more.poses);
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{57}, selection.count - 1}) {
    selection.count = count;
    const SelectedPoses fewer = select_poses(selection, kModel);
    ASSERT_EQ(fewer.poses.size(), count);
    ASSERT_EQ(fewer.condition.size(), count);
    EXPECT_TRUE(std::ranges::equal(values_of(fewer.poses), std::span(all).first(3 * count)));
    EXPECT_TRUE(std::ranges::equal(fewer.condition, std::span(more.condition).first(count)));
  }
}

INSTANTIATE_TEST_SUITE_P(Selections, FewerPoses,
                         testing::Values(interior(158), limited(Select::interior, 158),
                                         test::fake_box(Select::boundary, 158), limited(Select::boundary, 158)),
                         test::named({"Interior", "LimitedInterior", "Boundary", "LimitedBoundary"}));

class LimitedPoses : public testing::TestWithParam<Select> {};

TEST_P(LimitedPoses, AreFeasibleWithTheirCondition) {
  const SelectedPoses selected = select_poses(limited(GetParam(), 300), kModel);
  ASSERT_EQ(selected.poses.size(), 300u);
  ASSERT_EQ(selected.condition.size(), 300u);
  EXPECT_FALSE(selected.rejected.empty());
  for (std::size_t m = 0; m < 300; ++m) {
    const auto pose = selected.poses[PoseIndex(m)];
    EXPECT_TRUE(keeps_limits(pose)) << "pose " << m;
    EXPECT_EQ(selected.condition[m], kModel.condition(pose));
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_GE(pose[c], interior(1).workspace[c].lower);
      EXPECT_LE(pose[c], interior(1).workspace[c].upper);
    }
  }
}

TEST_P(LimitedPoses, AreTheSameEveryTime) {
  EXPECT_EQ(values_of(select_poses(limited(GetParam(), 100), kModel).poses),
            values_of(select_poses(limited(GetParam(), 100), kModel).poses));
}

INSTANTIATE_TEST_SUITE_P(All, LimitedPoses, testing::Values(Select::interior, Select::boundary, Select::grid),
                         test::named({"Interior", "Boundary", "Grid"}));

TEST(GridPoses, OfATableAreTheWholeGridWithBothEnds) {
  PoseSelection selection = test::fake_box(Select::grid, 30);
  selection.grid_counts = {1, 2, 15};
  const SelectedPoses selected = select_poses(selection, kModel);
  ASSERT_EQ(selected.poses.size(), 30u);
  for (std::size_t m = 0; m < 30; ++m) {
    const auto pose = selected.poses[PoseIndex(m)];
    EXPECT_DOUBLE_EQ(pose[0], -0.24);
    EXPECT_EQ(pose[1], m < 15 ? -0.5 : 0.5);
    EXPECT_NEAR(pose[2], -0.6 + 1.2 * static_cast<double>(m % 15) / 14.0, 1e-15);
  }
  EXPECT_EQ(selected.poses[PoseIndex(0)][2], -0.6);
  EXPECT_EQ(selected.poses[PoseIndex(14)][2], 0.6);
}

TEST(GridPoses, OfATableAreItsFeasiblePoints) {
  PoseSelection selection = limited(Select::grid, 5 * 6 * 7);
  selection.grid_counts = {5, 6, 7};
  const SelectedPoses selected = select_poses(selection, kModel);
  std::size_t expected = 0;
  for (std::size_t b = 0; b < 6; ++b) {
    for (std::size_t g = 0; g < 7; ++g) {
      const std::vector<double> pose{-0.2, std::lerp(-0.5, 0.5, static_cast<double>(b) / 5.0),
                                     std::lerp(-0.6, 0.6, static_cast<double>(g) / 6.0)};
      expected += keeps_limits(pose) ? 5 : 0;
    }
  }
  EXPECT_EQ(selected.poses.size(), expected);
  EXPECT_EQ(selected.poses.size() + test::total(selected.rejected), 210u);
}

TEST(RejectedPoses, AreToldByTheirNumberAndReason) {
  const std::vector<RejectedPoses> rejected{{"out of reach: limb 1 is stretched", 6},
                                            {"q_2 above 20 deg", 4},
                                            {"out of reach: limb 2 is stretched", 1},
                                            {"q_2 below 10 deg", 1},
                                            {"q_3 above 20 deg", 1},
                                            {"q_3 below 10 deg", 1}};
  EXPECT_EQ(rejected_text(rejected, 30),
            "14 of 30 poses examined in the workspace are not in this study: 7 out of reach; 4 q_2 above 20 deg; 1 q_2 "
            "below 10 deg; 1 q_3 above 20 deg; 1 for other reasons");
  EXPECT_TRUE(some_out_of_reach(rejected));
  EXPECT_FALSE(some_out_of_reach(std::span(rejected).subspan(1, 1)));
  EXPECT_EQ(rejected_text({}, 30), "");
  EXPECT_EQ(rejected_text(rejected, 0), "");
}

/// A boundary search has no number of candidates, and rejects poses in any workspace.
TEST(RejectedPoses, OfABoundaryTellIfTheReachEndsInTheWorkspace) {
  const RejectedPoses limited{"q_2 above 20 deg", 4};
  EXPECT_EQ(end_of_reach_text(std::vector{limited}), "");
  EXPECT_EQ(end_of_reach_text(std::vector{limited, RejectedPoses{"out of reach: too far", 2}}),
            "the mechanism does not reach all of the stated workspace, so poses of this boundary can be at the end of "
            "its reach, where small errors do much");
}

TEST(RejectedPoses, AreCountedAmongTheCandidates) {
  for (const Select select : {Select::interior, Select::grid}) {
    const SelectedPoses selected = select_poses(limited(select, 200), kModel);
    EXPECT_GE(selected.candidates, 200 + test::total(selected.rejected));
  }
  EXPECT_EQ(select_poses(limited(Select::boundary, 20), kModel).candidates, 0u);
}

TEST(GridPoses, OfANumberThatIsAPowerAreTheFullGrid) {
  PoseSelection table = test::fake_box(Select::grid, 64);
  table.grid_counts = {4, 4, 4};
  EXPECT_EQ(values_of(select_poses(test::fake_box(Select::grid, 64), kModel).poses),
            values_of(select_poses(table, kModel).poses));
}

TEST(GridPoses, OfAnyNumberAreDifferentPointsOfTheCoarsestGrid) {
  for (const std::size_t count : {1u, 2u, 63u, 65u, 158u}) {
    const PoseSet poses = select_poses(test::fake_box(Select::grid, count), kModel).poses;
    ASSERT_EQ(poses.size(), count);
    std::size_t number = 1;
    while (number * number * number < count) ++number;
    std::set<std::vector<double>> different;
    for (std::size_t m = 0; m < count; ++m) {
      const auto pose = poses[PoseIndex(m)];
      different.insert(std::vector<double>(pose.begin(), pose.end()));
      const double step = number == 1 ? 0.0 : (pose[1] + 0.5) * static_cast<double>(number - 1);
      EXPECT_NEAR(step, std::round(step), 1e-12);
    }
    EXPECT_EQ(different.size(), count);
  }
}

TEST(FilePoses, NameTheLineOfOneOutOfReach) {
  PoseSelection selection;
  selection.select = Select::file;
  selection.from_file.points = PoseSet(3, {-0.2, 0.0, 0.0, -0.25, 0.1, 0.0, 0.5, 20.0, 0.1});
  selection.place = {"poses.csv", 2, 1};
  test::expect_input_error([&] { select_poses(selection, kModel); }, {"poses.csv", 4, 1},
                           {"pose 3 (z = 0.5 m, beta = 20 rad = 1145.92 deg, gamma = 0.1 rad = 5.72958 deg)",
                            "z must be negative", "remove", "SI: metres and radians"});
  selection.from_file.points = PoseSet(3, {-0.2, 0.0, 0.0, -0.25, 0.1, 0.0});
  const SelectedPoses selected = select_poses(selection, kModel);
  EXPECT_EQ(selected.poses.column(0), (std::vector<double>{-0.2, -0.25}));
  EXPECT_EQ(selected.condition, (std::vector<double>{1.0, 1.0 / std::cos(0.1)}));
  EXPECT_TRUE(selected.rejected.empty());
  EXPECT_TRUE(selected.time.empty());
}

TEST(FilePoses, MayStandInTheCoordinatesOfAChart) {
  PoseSelection selection;
  selection.select = Select::file;
  selection.from_file = {0, PoseSet(3, {0.2, 0.3, 0.1, 0.25, 2.5, 0.0})};
  selection.place = {"poses.csv", 2, 1};
  test::expect_input_error([&] { select_poses(selection, kModel); }, {"poses.csv", 3, 1},
                           {"pose 2 (depth = 0.25 m, sum = 2.5 rad = 143.239 deg, difference = 0 rad = 0 deg)",
                            "no pose has these coordinates; make the sum smaller", "SI"});
  selection.from_file.points = PoseSet(3, {0.25, -2.5, 0.0});
  test::expect_input_error([&] { select_poses(selection, kModel); }, {"poses.csv", 2, 1},
                           {"is out of reach: both tilts end at -1 rad; make the sum smaller"});
  selection.from_file.points = PoseSet(3, {0.2, 0.3, 0.1});
  EXPECT_EQ(values_of(select_poses(selection, kModel).poses), (std::vector{-0.2, 0.2, 0.5 * (0.3 - 0.1)}));
}

class EmptyWorkspace : public testing::TestWithParam<Select> {};

TEST_P(EmptyWorkspace, NamesTheLimitThatEmptiedIt) {
  PoseSelection selection = test::fake_box(GetParam(), 20);
  selection.limits = {{1, {-9.0, 9.0}, {"study.toml", 13, 3}}, {0, {0.0, 0.08}, {"study.toml", 14, 8}}};
  test::expect_input_error([&] { select_poses(selection, kModel); }, {"study.toml", 14, 8},
                           {"the workspace is empty (q_1 above 80 mm: ", " candidates)", "make the limit wider"});
}

TEST_P(EmptyWorkspace, SaysThatNothingIsReached) {
  PoseSelection selection = test::fake_box(GetParam(), 20);
  selection.workspace[0] = {0.1, 0.2};
  test::expect_input_error(
      [&] { select_poses(selection, kModel); }, selection.place,
      {"the workspace is empty (out of reach: z must be negative: ",
       "; z is from 100 mm to 200 mm, in the mechanism's workspace from -300 mm to -180 mm", "into reach"});
}

TEST_P(EmptyWorkspace, SaysThatEveryPoseIsSingular) {
  PoseSelection selection = test::fake_box(GetParam(), 20);
  selection.workspace[1] = {0.6, 0.7};
  selection.max_condition = 1.125;
  test::expect_input_error([&] { select_poses(selection, kModel); }, selection.place,
                           {"the workspace is empty (singular: condition number above 1.125: ", "raise max_condition"});
}

/// A mechanism whose condition number is NaN at all poses.
class UndefinedCondition : public test::FakeModel {
 public:
  double condition(std::span<const double> /*pose*/) const override { return std::numeric_limits<double>::quiet_NaN(); }
};

TEST_P(EmptyWorkspace, CountsNoNumberAsSingular) {
  const PoseSelection selection = test::fake_box(GetParam(), 20);
  test::expect_input_error([&] { select_poses(selection, UndefinedCondition()); }, selection.place,
                           {"the workspace is empty (singular: condition number above "});
}

TEST(FilePoses, OfAConditionThatIsNoNumberAreSingular) {
  PoseSelection selection;
  selection.select = Select::file;
  selection.from_file = {std::nullopt, PoseSet(3, {-0.2, 0.2, 0.1})};
  selection.place = {"poses.csv", 2, 1};
  test::expect_input_error([&] { select_poses(selection, UndefinedCondition()); }, selection.place,
                           {"is singular or nearly so"});
}

INSTANTIATE_TEST_SUITE_P(All, EmptyWorkspace, testing::Values(Select::interior, Select::boundary, Select::grid),
                         test::named({"Interior", "Boundary", "Grid"}));

TEST(EmptyTable, NamesTheLimitThatEmptiedIt) {
  PoseSelection selection = limited(Select::grid, 8);
  selection.grid_counts = {2, 2, 2};
  selection.limits[0].range.lower = 0.2;
  test::expect_input_error([&] { select_poses(selection, kModel); }, {"study.toml", 13, 21},
                           {"the workspace is empty (q_2 below 11.4591559026 deg: 6 of 8 candidates)"});
}

TEST(ScarceWorkspace, SaysHowManyPosesWereFound) {
  PoseSelection selection = test::unit_cube(Select::interior, 200, 3);
  const test::RegionModel corner([](std::span<const double> pose) { return std::ranges::max(pose) < 0.1; });
  test::expect_input_error(
      [&] { select_poses(selection, corner); }, selection.place,
      {"the workspace gives only 98 of 200 poses (out of reach: outside the region: 99902 of 100000 candidates)"});
}

class VainSearch : public testing::TestWithParam<Select> {};

TEST_P(VainSearch, EndsInTime) {
  const test::RegionModel nowhere([](std::span<const double>) { return false; });
  std::size_t candidates = 0;
  EXPECT_THROW(select_poses(test::unit_cube(GetParam(), 20, 3), nowhere,
                            [&](const PoseSearch& search) {
                              candidates = search.candidates;
                              return true;
                            }),
               InputError);
  EXPECT_GE(candidates, 3'000u);
  EXPECT_LE(candidates, 15'000u);
}

TEST_P(VainSearch, IsLongerWhereSomePosesAreReached) {
  std::size_t candidates = 0;
  EXPECT_THROW(select_poses(test::fake_box(GetParam(), 20), UndefinedCondition(),
                            [&](const PoseSearch& search) {
                              candidates = search.candidates;
                              return true;
                            }),
               InputError);
  EXPECT_GE(candidates, 50'000u);
  EXPECT_LE(candidates, 120'000u);
}

TEST_P(VainSearch, IsTold) {
  const PoseSelection selection = test::fake_box(GetParam(), 20);
  PoseSearch last{};
  std::size_t calls = 0;
  const auto poses = select_poses(selection, kModel, [&](const PoseSearch& search) {
    EXPECT_EQ(search.wanted, 20u);
    EXPECT_EQ(search.candidates, ++calls);
    last = search;
    return true;
  });
  ASSERT_TRUE(poses);
  EXPECT_EQ(values_of(poses->poses), values_of(select_poses(selection, kModel).poses));
  EXPECT_LE(last.found, 20u);
}

TEST_P(VainSearch, StopsAtOnce) {
  const PoseSelection selection = test::fake_box(GetParam(), 2000);
  std::size_t calls = 0;
  EXPECT_FALSE(select_poses(selection, kModel, [&](const PoseSearch&) { return ++calls < 7; }));
  EXPECT_EQ(calls, 7u);
}

INSTANTIATE_TEST_SUITE_P(All, VainSearch, testing::Values(Select::interior, Select::boundary, Select::grid),
                         test::named({"Interior", "Boundary", "Grid"}));

TEST(ScarceWorkspace, SaysThatTheLastCandidatesGaveNone) {
  std::size_t tested = 0;
  const test::RegionModel few([&](std::span<const double>) { return ++tested <= 3; });
  test::expect_input_error([&] { select_poses(test::unit_cube(Select::interior, 20, 3), few); }, {"study.toml", 12, 13},
                           {"the workspace gives only 3 of 20 poses, the last 50000 candidates none "
                            "(out of reach: outside the region: 50000 of 50003 candidates)"});
}

TEST(ScarceWorkspace, GivesItsPosesAllTheSame) {
  const test::RegionModel corner([](std::span<const double> pose) { return std::ranges::max(pose) < 0.1; });
  EXPECT_EQ(select_poses(test::unit_cube(Select::interior, 90, 3), corner).poses.size(), 90u);
  EXPECT_EQ(select_poses(test::unit_cube(Select::boundary, 90, 3), corner).poses.size(), 90u);
  EXPECT_EQ(select_poses(test::unit_cube(Select::grid, 60, 3), corner).poses.size(), 60u);
}

TEST(FilePoses, AreWatchedToo) {
  PoseSelection selection;
  selection.select = Select::file;
  selection.from_file.points = PoseSet(3, {-0.2, 0.0, 0.0, -0.25, 0.1, 0.0});
  std::size_t calls = 0;
  EXPECT_TRUE(select_poses(selection, kModel, [&](const PoseSearch&) { return ++calls < 3; }));
  EXPECT_FALSE(select_poses(selection, kModel, [&](const PoseSearch&) { return false; }));
}

}  // namespace
}  // namespace poesy
