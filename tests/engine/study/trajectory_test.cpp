#include "engine/study/poses/pose_selection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"

namespace poesy {
namespace {

const test::FakeModel kModel;

Trajectory wave(std::size_t points, double start, double end) {
  Trajectory trajectory;
  trajectory.curve = 0;
  trajectory.origin = {0.3, -1.0, 0.5};
  trajectory.points = points;
  trajectory.time = Range{start, end};
  return trajectory;
}

/// A trajectory of points from a file with the coordinates z, beta and gamma. The given functions compute z and beta
/// from the time.
template <class Z, class Beta>
Trajectory file_of(const std::vector<double>& time, const Z& z, const Beta& beta) {
  Trajectory trajectory;
  trajectory.file = "curve.csv";
  trajectory.first_row = {"curve.csv", 2, 1};
  trajectory.from_file.time = time;
  std::vector<double> values;
  for (const double t : time) values.insert(values.end(), {z(t), beta(t), 0.0});
  trajectory.from_file.table.points = PoseSet(3, std::move(values));
  return trajectory;
}

PoseSelection selection_of(const Trajectory& trajectory) {
  PoseSelection selection;
  selection.select = PoseSelection::Select::trajectory;
  selection.trajectory = trajectory;
  selection.place = {"study.toml", 8, 14};
  return selection;
}

const auto kDeep = [](double) { return -0.2; };
const auto kUpright = [](double) { return 0.0; };

TEST(Curve, IsSampledEvenlyFromItsOrigin) {
  const SelectedPoses selected = select_poses(selection_of(wave(5, 1.0, 3.0)), kModel);
  EXPECT_EQ(selected.time, (std::vector{1.0, 1.5, 2.0, 2.5, 3.0}));
  ASSERT_EQ(selected.poses.size(), 5u);
  for (std::size_t m = 0; m < 5; ++m) {
    const double t = selected.time[m];
    const auto pose = selected.poses[PoseIndex(m)];
    EXPECT_DOUBLE_EQ(pose[0], -0.3 - 0.1 * std::sin(t));
    EXPECT_NEAR(pose[1] + pose[2], t - 1.0, 1e-15);
    EXPECT_NEAR(pose[1] - pose[2], 0.5, 1e-15);
    EXPECT_DOUBLE_EQ(selected.condition[m], kModel.condition(pose));
  }
}

TEST(File, GivesItsOwnPointsWhereNoNumberIsAsked) {
  const Trajectory trajectory = file_of(
      {0.0, 0.1, 7.0}, [](double t) { return -0.2 - t; }, kUpright);
  const SelectedPoses selected = select_poses(selection_of(trajectory), kModel);
  EXPECT_EQ(selected.time, trajectory.from_file.time);
  EXPECT_EQ(selected.poses.column(0), trajectory.from_file.table.points.column(0));
}

TEST(File, IsInterpolatedBetweenItsPoints) {
  std::vector<double> time;
  for (int k = 0; k <= 40; ++k) time.push_back(0.05 * k + 0.01 * std::sin(k));
  Trajectory trajectory = file_of(
      time, [](double t) { return -1.0 + 0.3 * std::sin(3.0 * t); }, kUpright);
  trajectory.points = 1001;
  trajectory.time = Range{time.front(), time.back()};
  const TimedPoints points = sampled(trajectory, kModel.description());
  const std::vector<double> z = points.table.points.column(0);
  ASSERT_EQ(z.size(), 1001u);
  EXPECT_EQ(points.time.front(), time.front());
  EXPECT_EQ(points.time.back(), time.back());
  EXPECT_EQ(z.back(), trajectory.from_file.table.points.column(0).back());
  for (std::size_t m = 0; m < z.size(); ++m) EXPECT_NEAR(z[m], -1.0 + 0.3 * std::sin(3.0 * points.time[m]), 2e-3);
}

TEST(File, IsMetAtItsPoints) {
  Trajectory trajectory = file_of(
      {0.0, 1.0, 2.0, 3.0, 4.0}, [](double t) { return t * t * t; }, kUpright);
  trajectory.points = 5;
  trajectory.time = Range{0.0, 4.0};
  const std::vector<double> z = sampled(trajectory, kModel.description()).table.points.column(0);
  for (std::size_t m = 0; m < 5; ++m) EXPECT_NEAR(z[m], std::pow(double(m), 3), 1e-13);
}

TEST(File, OfAStraightLineIsThatLineWithAnyNumberOfPoints) {
  for (std::size_t rows = 2; rows < 8; ++rows) {
    std::vector<double> time;
    for (std::size_t k = 0; k < rows; ++k) time.push_back(double(k * k));
    Trajectory trajectory = file_of(
        time, [](double t) { return 2.0 * t - 1.0; }, [](double t) { return 3.0 - t; });
    trajectory.points = 17;
    trajectory.time = Range{0.25, time.back() - 0.125};
    const TimedPoints points = sampled(trajectory, kModel.description());
    for (std::size_t m = 0; m < 17; ++m) {
      const auto point = points.table.points[PoseIndex(m)];
      EXPECT_NEAR(point[0], 2.0 * points.time[m] - 1.0, 1e-13) << rows;
      EXPECT_NEAR(point[1], 3.0 - points.time[m], 1e-13) << rows;
    }
  }
}

TEST(File, OfThreePointsIsJoinedByStraightLines) {
  Trajectory trajectory = file_of(
      {0.0, 1.0, 3.0}, [](double t) { return std::abs(t - 1.0); }, kUpright);
  trajectory.points = 7;
  trajectory.time = Range{0.0, 3.0};
  EXPECT_EQ(sampled(trajectory, kModel.description()).table.points.column(0),
            (std::vector{1.0, 0.5, 0.0, 0.5, 1.0, 1.5, 2.0}));
}

TEST(Refused, TheFirstPointThatNoPoseGives) {
  // sum = t - 1 exceeds 2 rad after t = 3.
  test::expect_input_error(
      [] { select_poses(selection_of(wave(9, 0.0, 4.0)), kModel); }, {"study.toml", 8, 14},
      {"point 8 of 9, at t = 3.5 s (depth = 264.922 mm, sum = 143.239 deg, difference = 28.6479 deg)",
       "no pose has these coordinates; make the sum smaller"});
}

TEST(Refused, TheFirstPointOutOfReach) {
  Trajectory trajectory = wave(5, 0.0, 2.0);
  trajectory.origin[0] = -0.09;
  test::expect_input_error([&] { select_poses(selection_of(trajectory), kModel); }, {"study.toml", 8, 14},
                           {"point 1 of 5, at t = 0 s (depth = -90 mm", "out of reach: z must be negative", "origin"});
}

TEST(Refused, TheFirstSingularPoint) {
  // beta = 90 deg at the third point, where the condition number is 1 / cos(beta).
  Trajectory trajectory = file_of({0.0, 1.0, 2.0}, kDeep, [](double t) { return t * std::acos(0.0) / 2.0; });
  const PoseSelection own = selection_of(trajectory);
  test::expect_input_error(
      [&] { select_poses(own, kModel); }, {"curve.csv", 4, 1},
      {"point 3 of 3, at t = 2 s (z = -200 mm, beta = 90 deg, gamma = 0 deg)", "singular",
       "condition number 1.63312e+16 is", "above max_condition, 1e+08", "raise max_condition", "SI"});
  PoseSelection strict = own;
  strict.max_condition = 1.2;
  test::expect_input_error([&] { select_poses(strict, kModel); }, {"curve.csv", 3, 1}, {"point 2 of 3", "1.41421"});
}

TEST(Refused, APointOfAnInterpolatedFileAtTheStudysPlace) {
  Trajectory trajectory = file_of(
      {0.0, 1.0}, [](double t) { return t - 0.5; }, kUpright);
  trajectory.points = 5;
  trajectory.time = Range{0.0, 1.0};
  test::expect_input_error([&] { select_poses(selection_of(trajectory), kModel); }, {"study.toml", 8, 14},
                           {"point 3 of 5, at t = 0.5 s", "z must be negative", "SI: metres and radians"});
}

}  // namespace
}  // namespace poesy
