#include "engine/study/study.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"

namespace poesy {
namespace {

PoseSelection interior(std::size_t count) {
  PoseSelection selection;
  selection.count = count;
  selection.workspace = {{-0.30, -0.18}, {-0.5, 0.5}, {-0.6, 0.6}};
  selection.place = {"study.toml", 12, 13};
  return selection;
}

TEST(SelectPoses, InteriorLiesInsideTheBoxWithoutRepetition) {
  const PoseSelection selection = interior(500);
  const PoseSet poses = select_poses(selection, test::FakeModel());
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

TEST(SelectPoses, InteriorIsSpreadEvenly) {
  const PoseSet poses = select_poses(interior(64), test::FakeModel());
  for (std::size_t c = 0; c < 3; ++c) {
    const Range range = interior(1).workspace[c];
    std::vector<int> in_eighth(8, 0);
    for (const double value : poses.column(c)) {
      ++in_eighth[static_cast<std::size_t>(8.0 * (value - range.lower) / (range.upper - range.lower))];
    }
    for (const int count : in_eighth) EXPECT_NEAR(count, 8, 1) << "coordinate " << c;
  }
}

TEST(SelectPoses, FewerInteriorPosesAreTheFirstOfMore) {
  const PoseSet more = select_poses(interior(158), test::FakeModel());
  for (const std::size_t count : {1u, 2u, 100u, 157u}) {
    const PoseSet fewer = select_poses(interior(count), test::FakeModel());
    ASSERT_EQ(fewer.size(), count);
    for (std::size_t m = 0; m < count; ++m) {
      const auto a = fewer[PoseIndex(m)];
      const auto b = more[PoseIndex(m)];
      EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin())) << "pose " << m << " of " << count;
    }
  }
}

TEST(SelectPoses, NamesTheInteriorPoseOutOfReach) {
  PoseSelection selection = interior(20);
  selection.workspace[0] = {0.1, 0.2};
  test::expect_input_error([&] { select_poses(selection, test::FakeModel()); }, selection.place,
                           {"pose 1 (z = 0.1", "beta = ", " rad", "z must be negative", "workspace smaller"});
}

TEST(SelectPoses, NamesTheLineOfTheFilePoseOutOfReach) {
  PoseSelection selection;
  selection.select = PoseSelection::Select::file;
  selection.from_file = PoseSet(3, {-0.2, 0.0, 0.0, -0.25, 0.1, 0.0, 0.5, 0.0, 0.1});
  selection.place = {"poses.csv", 2, 1};
  test::expect_input_error([&] { select_poses(selection, test::FakeModel()); }, {"poses.csv", 4, 1},
                           {"pose 3 (z = 0.5 m, beta = 0 rad, gamma = 0.1 rad)", "z must be negative", "remove"});
  selection.from_file = PoseSet(3, {-0.2, 0.0, 0.0, -0.25, 0.1, 0.0});
  EXPECT_EQ(select_poses(selection, test::FakeModel()).column(0), (std::vector<double>{-0.2, -0.25}));
}

TEST(BuildModel, TellsWhereAnImpossibleGeometryStands) {
  const Catalog catalog = test::fake_catalog();
  const MechanismChoice choice{&catalog[0], {-1.0}, {"study.toml", 5, 12}};
  test::expect_input_error([&] { build_model(choice); }, choice.place, {"arm must be greater than zero"});
}

TEST(BuildModel, PassesTheGeometryOn) {
  const Catalog catalog = test::fake_catalog();
  const auto model = build_model({&catalog[0], {0.5}, {}});
  const std::vector<double> pose{-0.2, 0.1, 0.1};
  const std::vector<double> errors{1e-3, 0.0, 0.0};
  std::vector<double> responses(2);
  std::vector<SolveStatus> status(1);
  std::vector<std::uint32_t> iterations(1);
  model->evaluator({})->evaluate({pose, errors, {}, {}, 1}, {responses, status, iterations, {}});
  EXPECT_DOUBLE_EQ(responses[0], 0.5 * 2.0 * 1.5 * 1e-3);
}

TEST(BackgroundErrors, ApplyByDimensionAndOnlyToTheirFactors) {
  const Catalog catalog = test::fake_catalog();
  Study study;
  study.mechanism.entry = &catalog[0];
  EXPECT_EQ(background_errors(study), (std::vector<double>{0.0, 0.0, 0.0}));
  study.analysis.background = Background{{FactorIndex(1), FactorIndex(2)}, 1e-3, 2e-2};
  EXPECT_EQ(background_errors(study), (std::vector<double>{0.0, 2e-2, 1e-3}));
}

TEST(Names, AreThoseOfTheStudyFile) {
  using Select = PoseSelection::Select;
  EXPECT_EQ(name(Select::interior), "interior");
  EXPECT_EQ(name(Select::file), "file");
  EXPECT_EQ(name(Select::boundary), "boundary");
  EXPECT_EQ(name(Select::grid), "grid");
  EXPECT_EQ(name(Select::trajectory), "trajectory");
  EXPECT_EQ(name(Analysis::Kind::sensitivity), "sensitivity");
  EXPECT_EQ(name(Analysis::Kind::identification), "identification");
  EXPECT_EQ(name(Analysis::Kind::evaluate), "evaluate");
  EXPECT_EQ(name(Analysis::Kind::monte_carlo), "monte-carlo");
  EXPECT_EQ(name(NotConverged::exclude), "exclude");
  EXPECT_EQ(name(NotConverged::include), "include");
  EXPECT_EQ(name(NotConverged::fail), "fail");
  EXPECT_EQ(name(SolverOptions::Method::newton), "newton");
  EXPECT_EQ(name(SolverOptions::Method::gauss_newton), "gauss-newton");
}

}  // namespace
}  // namespace poesy
