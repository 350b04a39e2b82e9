#include "engine/base/ratio.h"

#include <gtest/gtest.h>

namespace poesy {
namespace {

TEST(Ratio, ReadsShares) {
  EXPECT_EQ(parse_ratio("0.1 %"), 0.001);
  EXPECT_EQ(parse_ratio(" -2.5% "), -0.025);
  EXPECT_EQ(parse_ratio("200 ppm"), 2e-4);
  EXPECT_DOUBLE_EQ(*parse_ratio("50 um/m"), 5e-5);
  EXPECT_DOUBLE_EQ(*parse_ratio("1e-1 mm / m"), 1e-4);
  EXPECT_DOUBLE_EQ(*parse_ratio("3 mrad/rad"), 3e-3);
  EXPECT_EQ(ratio_unit("%"), 0.01);
}

TEST(Ratio, ReadsNothingElse) {
  for (const char* text : {"", "%", "0.001", "50 um", "50 um/deg", "50 um/", "x %", "1 %%", "1 m/m/m", "1e999 %"}) {
    EXPECT_FALSE(parse_ratio(text)) << text;
  }
}

}  // namespace
}  // namespace poesy
