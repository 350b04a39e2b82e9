#include "engine/app/progress.h"

#include <gtest/gtest.h>

#include <array>
#include <string_view>
#include <utility>

#include "engine/base/error.h"

namespace poesy::app {
namespace {

TEST(ReadableDuration, HasOneOrTwoParts) {
  constexpr std::pair<double, std::string_view> kExpected[] = {
      {0.0, "0 s"},           {0.234, "0.23 s"}, {4.0, "4 s"},          {9.96, "10 s"},
      {59.4, "59 s"},         {59.6, "1 min"},   {80.0, "1 min 20 s"},  {84.9, "1 min 20 s"},
      {594.0, "9 min 50 s"},  {596.0, "10 min"}, {2100.0, "35 min"},    {3571.0, "1 h"},
      {7800.0, "2 h 10 min"}, {86380.0, "1 d"},  {100800.0, "1 d 4 h"}, {864000.0, "10 d"}};
  for (const auto& [seconds, text] : kExpected) EXPECT_EQ(readable_duration(seconds), text);
}

ProgressFacts facts() { return {{.solves = 432000, .total = 1000000, .not_converged = 12}, 7100.0}; }

TEST(SearchLine, SaysWhatIsFound) {
  EXPECT_EQ(search_line({.found = 12, .wanted = 100, .candidates = 34000}),
            "looking for poses: 12 of 100 found, 34000 candidates");
}

TEST(PlainLine, SaysEverything) {
  EXPECT_EQ(plain_line(facts()), "43.2 % done, 7.1 k samples/s, 12 not converged (0.0028 %), 1 min 20 s left");
}

TEST(PlainLine, HasNoShareOfNoFailures) {
  ProgressFacts none = facts();
  none.progress.not_converged = 0;
  EXPECT_EQ(plain_line(none), "43.2 % done, 7.1 k samples/s, 0 not converged, 1 min 20 s left");
}

TEST(PlainLine, NamesTheStage) {
  ProgressFacts second = facts();
  second.stage = 2;
  EXPECT_TRUE(plain_line(second).starts_with("stage 2: 43.2 % done"));
}

TEST(PlainLine, NamesTheDesignOfASweep) {
  ProgressFacts fourth = facts();
  fourth.design = 4;
  fourth.designs = 10;
  EXPECT_EQ(plain_line(fourth),
            "design 4 of 10: 43.2 % done, 7.1 k samples/s, 12 not converged (0.0028 %), 15 min left");
  fourth.stage = 2;
  EXPECT_TRUE(plain_line(fourth).starts_with("design 4 of 10, stage 2: 43.2 % done"));
}

TEST(ValidationLine, SaysHowManyDesignsAreValid) {
  EXPECT_EQ(validation_line(3, 10), "validating designs: 3 of 10 done");
}

TEST(PlainLine, IsNotReadyBeforeTheEnd) {
  ProgressFacts almost = facts();
  almost.progress.solves = 999999;
  EXPECT_TRUE(plain_line(almost).starts_with("99.9 % done"));
  EXPECT_TRUE(plain_line(almost).ends_with(" 1 s left"));
  almost.progress.solves = 1000000;
  EXPECT_TRUE(plain_line(almost).starts_with("100.0 % done"));
}

TEST(ProgressLines, SayNoRateAndNoTimeUntilThereIsARate) {
  ProgressFacts begun = facts();
  begun.rate = 0.0;
  EXPECT_EQ(plain_line(begun), "43.2 % done, 12 not converged (0.0028 %), time left unknown");
  for (std::size_t width = 20; width <= 120; ++width) {
    EXPECT_EQ(live_line(begun, width).find("samples/s"), std::string::npos) << width;
  }
}

TEST(PlainLine, WritesRatesShort) {
  ProgressFacts fast = facts();
  for (const auto& [rate, text] : {std::pair{0.5, ", 0.5 samples/s"},
                                   {999.4, ", 999 samples/s"},
                                   {999.6, ", 1 k samples/s"},
                                   {7.213e6, ", 7.21 M samples/s"},
                                   {2e9, ", 2 G samples/s"}}) {
    fast.rate = rate;
    EXPECT_NE(plain_line(fast).find(text), std::string::npos) << plain_line(fast);
  }
}

TEST(LiveLine, FitsAnyWidth) {
  for (std::size_t width = 0; width <= 250; ++width) {
    for (const std::uint64_t failed : {0U, 12U, 400000U}) {
      ProgressFacts any = facts();
      any.progress.not_converged = failed;
      EXPECT_LE(live_line(any, width).size(), width);
    }
  }
}

TEST(LiveLine, SaysLessWhereThereIsLessRoom) {
  const std::array<std::pair<std::size_t, std::string>, 6> expected{{
      {101, " 43.2 % [############................]  7.1 k samples/s  12 not converged (0.0028 %)  1 min 20 s left"},
      {80, " 43.2 % [###....]  7.1 k samples/s  12 not converged (0.0028 %)  1 min 20 s left"},
      {75, "43.2 % done, 7.1 k samples/s, 12 not converged (0.0028 %), 1 min 20 s left"},
      {53, " 43.2 % [###......]  7.1 k samples/s  1 min 20 s left"},
      {39, " 43.2 % [#####.......]  1 min 20 s left"},
      {24, "43.2 %, 1 min 20 s left"},
  }};
  for (const auto& [width, line] : expected) EXPECT_EQ(live_line(facts(), width), line) << width;
  EXPECT_EQ(live_line(facts(), 10), "43.2 %");
  EXPECT_EQ(live_line(facts(), 3), "");
}

TEST(LiveLine, KeepsTheBarWhileTheTimeChanges) {
  const auto bar_end = [](double rate) {
    ProgressFacts any = facts();
    any.rate = rate;
    return live_line(any, 79).find(']');
  };
  EXPECT_EQ(bar_end(7100.0), bar_end(8000.0));
  EXPECT_EQ(bar_end(7100.0), bar_end(100000.0));
  EXPECT_EQ(bar_end(7100.0), bar_end(123.0));
}

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
