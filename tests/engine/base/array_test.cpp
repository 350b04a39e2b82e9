#include "engine/base/array.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

namespace poesy {
namespace {

using Cube = Array<int, axis::Response, axis::Factor, axis::Pose>;
constexpr Cube::Lengths kLengths{2, 3, 4};

/// An array whose elements are 0, 1, 2, ... in the order of the memory.
Cube counting() {
  std::vector<int> elements(24);
  std::iota(elements.begin(), elements.end(), 0);
  return {kLengths, elements};
}

TEST(Array, KnowsItsAxes) {
  EXPECT_EQ(Cube::axis_names(), (std::vector<std::string>{"response", "factor", "pose"}));
  const Cube cube = counting();
  EXPECT_EQ(cube.lengths(), kLengths);
  EXPECT_EQ(cube.length<axis::Response>(), 2u);
  EXPECT_EQ(cube.length<axis::Factor>(), 3u);
  EXPECT_EQ(cube.length<axis::Pose>(), 4u);
  EXPECT_EQ(cube.size(), 24u);
}

TEST(Array, CountsItsLastAxisFastest) {
  const Cube cube = counting();
  int next = 0;
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t f = 0; f < 3; ++f) {
      for (std::size_t m = 0; m < 4; ++m) EXPECT_EQ(cube(r, f, m), next++);
    }
  }
}

TEST(Array, GivesRowsAlongTheAxesLeft) {
  Cube cube = counting();
  EXPECT_EQ(cube.row(1, 2).size(), 4u);
  EXPECT_EQ(cube.row(1, 2).front(), 20);
  EXPECT_EQ(cube.row(1).size(), 12u);
  EXPECT_EQ(cube.row(1).front(), 12);
  EXPECT_EQ(cube.row().size(), 24u);
  cube.row(0, 1)[3] = -1;
  EXPECT_EQ(cube(0, 1, 3), -1);
}

TEST(Array, IsEmptyByDefault) {
  const Cube none;
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.length<axis::Pose>(), 0u);
  EXPECT_EQ(none, Cube());
  EXPECT_FALSE(none == counting());
}

TEST(Array, EqualNeedsEqualLengths) {
  using Table = Array<int, axis::Factor, axis::Pose>;
  EXPECT_FALSE(Table({2, 3}) == Table({3, 2}));
  EXPECT_EQ(Table({2, 3}, 5), Table({2, 3}, std::vector<int>(6, 5)));
}

TEST(Array, GetsRoomTogetherWithOthersOfItsAxes) {
  Cube cube = counting();
  Array<double, axis::Response, axis::Factor, axis::Pose> other;
  make_room({1, 2, 2}, cube, other);
  EXPECT_EQ(cube, Cube({1, 2, 2}, 0));
  EXPECT_EQ(other.lengths(), cube.lengths());
}

TEST(ArrayView, SeesElementsElsewhere) {
  std::vector<int> elements(24);
  const ArrayView<int, axis::Response, axis::Sample> view(elements, {4, 6});
  view(3, 5) = 7;
  EXPECT_EQ(elements.back(), 7);
  EXPECT_EQ(view.row(3).back(), 7);
  EXPECT_EQ(view.length<axis::Sample>(), 6u);
}

}  // namespace
}  // namespace poesy
