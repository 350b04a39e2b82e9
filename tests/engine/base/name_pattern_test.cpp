#include "engine/base/name_pattern.h"

#include <gtest/gtest.h>

#include <string>

namespace poesy {
namespace {

TEST(NamePattern, StarStandsForAnyLettersAndQuestionMarkForOne) {
  EXPECT_TRUE(matches("delta_1_*", "delta_1_4_x"));
  EXPECT_TRUE(matches("*_x", "delta_1_4_x"));
  EXPECT_TRUE(matches("d*1*x", "delta_1_4_x"));
  EXPECT_TRUE(matches("delta_?_4_?", "delta_1_4_x"));
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("", ""));
  EXPECT_FALSE(matches("", "x"));
  EXPECT_FALSE(matches("?", ""));
  EXPECT_FALSE(matches("delta_2_*", "delta_1_4_x"));
  EXPECT_FALSE(matches("delta_1_4", "delta_1_4_x"));
  EXPECT_FALSE(matches("*_y", "delta_1_4_x"));
}

TEST(NamePattern, OfManyStarsIsFast) {
  std::string pattern;
  for (int k = 0; k < 2000; ++k) pattern += "*a";
  EXPECT_FALSE(matches(pattern + "b", std::string(20'000, 'a')));
}

}  // namespace
}  // namespace poesy
