#include "engine/app/duration.h"

#include <gtest/gtest.h>

#include <string_view>
#include <utility>

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

}  // namespace
}  // namespace poesy::app
