#include "engine/study/poses/workspace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/engine/study/region.h"
#include "tests/support/input_error.h"

namespace poesy {
namespace {

using Select = PoseSelection::Select;

double distance_to_centre(std::span<const double> point) {
  double sum = 0.0;
  for (const double value : point) sum += (value - 0.5) * (value - 0.5);
  return std::sqrt(sum);
}

class BoundaryIn : public testing::TestWithParam<std::size_t> {};

TEST_P(BoundaryIn, OfABoxLiesOnItsFacesExactly) {
  const std::size_t dimension = GetParam();
  const PoseSelection selection =
      test::selection_of(Select::boundary, 200, std::vector<Range>(dimension, {-0.3, 0.1 * std::numbers::pi}));
  const SelectedPoses selected = boundary_poses(selection, test::kWholeBox);
  ASSERT_EQ(selected.poses.size(), 200u);
  EXPECT_TRUE(selected.rejected.empty());
  for (std::size_t m = 0; m < 200; ++m) {
    const auto pose = selected.poses[PoseIndex(m)];
    EXPECT_EQ(
        std::ranges::count_if(pose, [](double value) { return value == -0.3 || value == 0.1 * std::numbers::pi; }), 1)
        << "pose " << m;
    EXPECT_GE(std::ranges::min(pose), -0.3);
    EXPECT_LE(std::ranges::max(pose), 0.1 * std::numbers::pi);
  }
}

TEST_P(BoundaryIn, OfABallLiesOnItsSurface) {
  const std::size_t dimension = GetParam();
  const test::RegionModel ball([](std::span<const double> point) { return distance_to_centre(point) <= 0.49; });
  const SelectedPoses selected = boundary_poses(test::unit_cube(Select::boundary, 200, dimension), ball);
  ASSERT_EQ(selected.poses.size(), 200u);
  EXPECT_GT(test::total(selected.rejected), 0u);
  for (std::size_t m = 0; m < 200; ++m) {
    const auto pose = selected.poses[PoseIndex(m)];
    EXPECT_LE(distance_to_centre(pose), 0.49) << "pose " << m;
    EXPECT_NEAR(distance_to_centre(pose), 0.49, 1e-14) << "pose " << m;
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, BoundaryIn, testing::Values(2, 3, 4, 6), testing::PrintToStringParamName());

TEST(Boundary, OfOneCoordinateIsTheEndsOfIntervals) {
  const test::RegionModel two_pieces(
      [](std::span<const double> pose) { return pose[0] <= 0.25 || (pose[0] >= 0.5 && pose[0] <= 0.7); });
  const SelectedPoses selected = boundary_poses(test::unit_cube(Select::boundary, 4, 1), two_pieces);
  std::vector<double> ends = selected.poses.column(0);
  ASSERT_EQ(ends.size(), 4u);
  std::ranges::sort(ends);
  EXPECT_EQ(ends[0], 0.0);
  EXPECT_NEAR(ends[1], 0.25, 1e-15);
  EXPECT_NEAR(ends[2], 0.5, 1e-15);
  EXPECT_NEAR(ends[3], 0.7, 1e-15);
}

TEST(Boundary, RefusesMorePosesThanThereAreEnds) {
  const PoseSelection selection = test::unit_cube(Select::boundary, 3, 1);
  test::expect_input_error(
      [&] { boundary_poses(selection, test::kWholeBox); }, selection.count_place,
      {"poses.count is 3, more poses of the boundary than can be separated at rounding", "ask for fewer poses"});
}

TEST(Boundary, RefusesPosesThatCoincideInABoxAsThinAsRounding) {
  const double next = std::nextafter(0.1, 1.0);
  const PoseSelection selection = test::selection_of(Select::boundary, 20, {{0.1, next}, {0.1, next}});
  test::expect_input_error([&] { boundary_poses(selection, test::kWholeBox); }, selection.count_place,
                           {"separated at rounding"});
}

TEST(Boundary, FindsBothSidesOfAHole) {
  const test::RegionModel shell([](std::span<const double> point) {
    const double distance = distance_to_centre(point);
    return distance <= 0.45 && distance >= 0.3;
  });
  const SelectedPoses selected = boundary_poses(test::unit_cube(Select::boundary, 4000, 3), shell);
  std::size_t inner = 0;
  for (std::size_t m = 0; m < 4000; ++m) {
    const double distance = distance_to_centre(selected.poses[PoseIndex(m)]);
    EXPECT_TRUE(std::abs(distance - 0.45) < 1e-14 || std::abs(distance - 0.3) < 1e-14) << distance;
    inner += distance < 0.4 ? 1 : 0;
  }
  // The inner sphere has the share 0.3^2 / (0.3^2 + 0.45^2) = 4 / 13 of the area.
  EXPECT_NEAR(static_cast<double>(inner) / 4000.0, 4.0 / 13.0, 0.02);
}

TEST(Boundary, DoesNotDependOnTheUnitsOfTheBox) {
  const auto in_cube = boundary_poses(test::unit_cube(Select::boundary, 100, 2), test::kWholeBox);
  const auto scaled =
      boundary_poses(test::selection_of(Select::boundary, 100, {{0.0, 4.0}, {0.0, 0.25}}), test::kWholeBox);
  for (std::size_t m = 0; m < 100; ++m) {
    EXPECT_DOUBLE_EQ(scaled.poses[PoseIndex(m)][0], 4.0 * in_cube.poses[PoseIndex(m)][0]);
    EXPECT_DOUBLE_EQ(scaled.poses[PoseIndex(m)][1], 0.25 * in_cube.poses[PoseIndex(m)][1]);
  }
}

}  // namespace
}  // namespace poesy
