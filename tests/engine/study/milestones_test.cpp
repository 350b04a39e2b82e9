#include "engine/study/plan.h"

#include <gtest/gtest.h>

namespace poesy {
namespace {

using List = std::vector<std::size_t>;

TEST(Milestones, GrowByHalfInWholeUnits) {
  EXPECT_EQ(milestones(1000, 30000), (List{1000, 2000, 3000, 5000, 8000, 12000, 18000, 27000}));
  EXPECT_EQ(milestones(4000, 20000), (List{4000, 6000, 9000, 14000}));
}

TEST(Milestones, BeginWithMinRoundedUp) {
  EXPECT_EQ(milestones(2, 3000), (List{1000, 2000}));
  EXPECT_EQ(milestones(1001, 3001), (List{2000, 3000}));
}

TEST(Milestones, AreBelowMax) {
  EXPECT_EQ(milestones(1000, 8000), (List{1000, 2000, 3000, 5000}));
  EXPECT_EQ(milestones(1000, 8001), (List{1000, 2000, 3000, 5000, 8000}));
  EXPECT_EQ(milestones(1000, 1000), List());
  EXPECT_EQ(milestones(2, 700), List());
}

TEST(Milestones, OfALargerMaxBeginWithTheSame) {
  const List longest = milestones(1500, 1'000'000'000'000'000);
  for (std::size_t max = 1500; max < 100'000; max += 499) {
    const List list = milestones(1500, max);
    ASSERT_LT(list.size(), longest.size());
    EXPECT_TRUE(std::equal(list.begin(), list.end(), longest.begin()));
  }
  for (const std::size_t milestone : longest) EXPECT_EQ(milestone % Plan::kUnitSamples, 0u);
}

}  // namespace
}  // namespace poesy
