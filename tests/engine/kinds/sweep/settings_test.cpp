#include "engine/kinds/sweep/settings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/error.h"

namespace poesy::sweep {
namespace {

using Values = std::vector<std::string>;

TEST(SweptKeys, OfARangeHaveItsEnds) {
  const SweptKey swept = parse_swept("geometry.R=250:300:10mm");
  EXPECT_EQ(swept.key, "mechanism.geometry.R");
  EXPECT_EQ(swept.values, (Values{"250 mm", "260 mm", "270 mm", "280 mm", "290 mm", "300 mm"}));
  EXPECT_EQ(parse_swept("k=0.1:0.3:0.1").values, (Values{"0.1", "0.2", "0.3"}));  // not 0.30000000000000004
  EXPECT_EQ(parse_swept("k=1:-1:-1 deg").values, (Values{"1 deg", "0 deg", "-1 deg"}));
  EXPECT_EQ(parse_swept("k=-0.3:0.3:0.1").values[3], "0");
  EXPECT_EQ(parse_swept("k=0:5:2").values, (Values{"0", "2", "4"}));  // 5 is not reached
  EXPECT_EQ(parse_swept("k=1mm:2mm:1mm").values, (Values{"1 mm", "2 mm"}));
}

TEST(SweptKeys, OfAListHaveTheUnitOfTheLast) {
  EXPECT_EQ(parse_swept("a.b=200,250,300 mm").values, (Values{"200 mm", "250 mm", "300 mm"}));
  EXPECT_EQ(parse_swept("a.b=20 cm, 300mm").values, (Values{"20 cm", "300 mm"}));
  EXPECT_EQ(parse_swept("solver.method=newton,gauss-newton").values, (Values{"newton", "gauss-newton"}));
  EXPECT_EQ(parse_swept("x=[1,2],[3,4]").values, (Values{"[1,2]", "[3,4]"}));
  EXPECT_EQ(parse_swept("x=\"a,b\",c").values, (Values{"\"a,b\"", "c"}));
  EXPECT_EQ(parse_swept("x={ to = 1, from = 0 },2").values[0], "{ to = 1, from = 0 }");
}

TEST(SweptKeys, ThatAreWrongAreRefused) {
  for (const char* text :
       {"",          "=",        "k",       "=1,2",     "k=",        "k=1",     "k=1,",          "k=1,1",
        "k=1:2",     "k=1:2:0",  "k=2:1:1", "k=1:2:2",  "k=1:2:3:4", "k=a:b:c", "k=1mm:2cm:1mm", "k=0:1e9:1",
        "k=1:nan:1", "k=1:2:-1", "k=1::1",  "k=0:inf:1"}) {
    EXPECT_THROW(parse_swept(text), InputError) << text;
  }
}

TEST(SweptKeys, FormAGridWhoseLastKeyChangesFastest) {
  const std::vector<SweptKey> keys{{"a", {"1", "2"}}, {"b", {"x", "y", "z"}}};
  const std::vector<std::vector<GivenKey>> grid = grid_of(keys);
  ASSERT_EQ(grid.size(), 6U);
  EXPECT_EQ(grid[1], (std::vector<GivenKey>{{"a", "1"}, {"b", "y"}}));
  EXPECT_EQ(grid[3], (std::vector<GivenKey>{{"a", "2"}, {"b", "x"}}));
  EXPECT_THROW(grid_of(std::vector<SweptKey>{{"a", {"1", "2"}}, {"a", {"3", "4"}}}), InputError);
  const SweptKey many = parse_swept("k=1:40:1");
  EXPECT_THROW(grid_of(std::vector<SweptKey>{many, {"l", many.values}}), InputError);
}

TEST(SweptNumbers, AreReadWithTheirUnits) {
  EXPECT_EQ(number_of("260 mm").number, 260.0);
  EXPECT_EQ(number_of("260mm").unit, "mm");
  EXPECT_EQ(number_of("-1.5e-3").number, -1.5e-3);
  EXPECT_EQ(number_of("99 %").unit, "%");
  EXPECT_EQ(number_of("2 N m").unit, "N m");
  for (const char* text : {"newton", "", "mm", "3 parsec", "[1, 2]", "1 2"}) {
    EXPECT_TRUE(std::isnan(number_of(text).number)) << text;
  }
}

}  // namespace
}  // namespace poesy::sweep
