#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/study/poses/workspace.h"
#include "tests/engine/study/region.h"

namespace poesy {
namespace {

using Select = PoseSelection::Select;
using Point = std::span<const double>;

/// Probability that a test fails although the poses are uniform by area. The random numbers are fixed, so a test always
/// gives the same result.
constexpr double kAlpha = 1e-3;
constexpr std::size_t kCount = 20'000;

/// Pearson's chi-square test that the numbers of poses in cells are proportional to the cells' areas.
void expect_shares(const PoseSet& poses, const std::vector<double>& areas,
                   const std::function<std::size_t(Point)>& cell_of) {
  std::vector<double> counts(areas.size(), 0.0);
  for (std::size_t m = 0; m < poses.size(); ++m) ++counts.at(cell_of(poses[PoseIndex(m)]));
  double whole = 0.0;
  for (const double area : areas) whole += area;
  double statistic = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    const double expected = static_cast<double>(poses.size()) * areas[k] / whole;
    ASSERT_GT(expected, 5.0);
    statistic += (counts[k] - expected) * (counts[k] - expected) / expected;
  }
  const boost::math::chi_squared distribution(static_cast<double>(areas.size() - 1));
  EXPECT_LT(statistic, boost::math::quantile(boost::math::complement(distribution, kAlpha)));
}

PoseSet boundary_of(const Model& model, std::size_t dimension, std::size_t count = kCount) {
  return boundary_poses(test::unit_cube(Select::boundary, count, dimension), model).poses;
}

/// The number of the unit cube's face that the pose is on: 2 c if coordinate c is 0, 2 c + 1 if it is 1. Inside the
/// cube it is 2 x number of coordinates.
std::size_t face_of(Point pose) {
  for (std::size_t c = 0; c < pose.size(); ++c) {
    if (pose[c] == 0.0) return 2 * c;
    if (pose[c] == 1.0) return 2 * c + 1;
  }
  return 2 * pose.size();
}

class BoundaryOfTheBox : public testing::TestWithParam<std::size_t> {};

TEST_P(BoundaryOfTheBox, MeetsFacesAlike) {
  const std::size_t dimension = GetParam();
  for (const std::size_t count : {std::size_t{692}, kCount}) {
    expect_shares(boundary_of(test::kWholeBox, dimension, count), std::vector<double>(2 * dimension, 1.0), face_of);
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, BoundaryOfTheBox, testing::Values(2, 3, 4, 6), testing::PrintToStringParamName());

TEST(BoundaryOfTheBox, CoversEveryFaceEvenly) {
  constexpr std::size_t kPatches = 5;
  expect_shares(boundary_of(test::kWholeBox, 3), std::vector<double>(6 * kPatches * kPatches, 1.0), [](Point pose) {
    const std::size_t face = face_of(pose);
    std::size_t patch = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      if (c != face / 2) patch = kPatches * patch + static_cast<std::size_t>(pose[c] * kPatches);
    }
    return face * kPatches * kPatches + patch;
  });
}

TEST(BoundaryOfABall, IsUniformInHeightAndLongitude) {
  const test::RegionModel ball([](Point p) { return std::hypot(p[0] - 0.5, p[1] - 0.5, p[2] - 0.5) <= 0.35; });
  constexpr std::size_t kBands = 10;
  constexpr std::size_t kSectors = 8;
  // Archimedes: bands of equal height have equal areas.
  expect_shares(boundary_of(ball, 3), std::vector<double>(kBands * kSectors, 1.0), [](Point p) {
    const double height = std::clamp((p[2] - 0.15) / 0.7, 0.0, 1.0 - 1e-12);
    const double turn = std::atan2(p[1] - 0.5, p[0] - 0.5) / (2.0 * std::numbers::pi) + 0.5;
    return kSectors * static_cast<std::size_t>(height * kBands) +
           static_cast<std::size_t>(std::min(turn, 1.0 - 1e-12) * kSectors);
  });
}

TEST(BoundaryOfABallCutByTheBox, HasSharesOfCapsAndDiscs) {
  // A ball of radius 0.6 about the centre of the cube. The faces cut it in discs with radius^2 = 0.11, which removes
  // caps of height 0.1 from the sphere.
  const test::RegionModel ball([](Point p) { return std::hypot(p[0] - 0.5, p[1] - 0.5, p[2] - 0.5) <= 0.6; });
  const double disc = std::numbers::pi * 0.11;
  const double sphere = 4.0 * std::numbers::pi * 0.36 - 6.0 * 2.0 * std::numbers::pi * 0.6 * 0.1;
  expect_shares(boundary_of(ball, 3), {disc, disc, disc, disc, disc, disc, sphere}, face_of);
}

TEST(BoundaryUnderALimit, HasTheAreasOfItsFaces) {
  // Joint q_2 is beta + gamma, so its limit cuts the box along an oblique plane.
  PoseSelection selection = test::selection_of(Select::boundary, kCount, {{-2.0, -1.0}, {0.0, 1.0}, {0.0, 1.0}});
  selection.limits = {{1, {-1.0, 1.0}, {}}};
  const PoseSet poses = boundary_poses(selection, test::FakeModel()).poses;
  // The boundary has two triangles of area 1/2, two squares of area 1 and the oblique plane of area sqrt(2).
  expect_shares(poses, {0.5, 0.5, 1.0, 1.0, std::numbers::sqrt2}, [](Point p) -> std::size_t {
    if (p[0] == -2.0) return 0;
    if (p[0] == -1.0) return 1;
    if (p[1] == 0.0) return 2;
    if (p[2] == 0.0) return 3;
    return 4;
  });
}

TEST(BoundaryInThePlane, HasTheLengthsOfItsArcs) {
  const test::RegionModel disc([](Point p) { return std::hypot(p[0] - 0.5, p[1] - 0.5) <= 0.4; });
  expect_shares(boundary_of(disc, 2), std::vector<double>(50, 1.0), [](Point p) {
    const double turn = std::atan2(p[1] - 0.5, p[0] - 0.5) / (2.0 * std::numbers::pi) + 0.5;
    return static_cast<std::size_t>(std::min(turn, 1.0 - 1e-12) * 50.0);
  });
}

}  // namespace
}  // namespace poesy
