#include "engine/app/recent_rate.h"

#include <gtest/gtest.h>

namespace poesy::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const RecentRate::Clock::time_point kStart{};

TEST(RecentRate, IsZeroBeforeAnythingIsDone) { EXPECT_EQ(RecentRate(kStart).per_second(), 0.0); }

TEST(RecentRate, CountsFromTheStartAtFirst) {
  RecentRate rate(kStart);
  rate.add(kStart + milliseconds(100), 50);
  EXPECT_DOUBLE_EQ(rate.per_second(), 500.0);
  rate.add(kStart + seconds(2), 1000);
  EXPECT_DOUBLE_EQ(rate.per_second(), 500.0);
}

TEST(RecentRate, ForgetsWhatIsLongAgo) {
  RecentRate rate(kStart);
  std::uint64_t done = 0;
  for (int second = 1; second <= 100; ++second) rate.add(kStart + seconds(second), done += 1000);
  EXPECT_DOUBLE_EQ(rate.per_second(), 1000.0);
  for (int second = 101; second <= 130; ++second) rate.add(kStart + seconds(second), done += 10);
  EXPECT_DOUBLE_EQ(rate.per_second(), 10.0);
}

TEST(RecentRate, FollowsAStandstill) {
  RecentRate rate(kStart);
  rate.add(kStart + seconds(1), 1000);
  for (int second = 2; second <= 30; ++second) rate.add(kStart + seconds(second), 1000);
  EXPECT_EQ(rate.per_second(), 0.0);
}

}  // namespace
}  // namespace poesy::app
