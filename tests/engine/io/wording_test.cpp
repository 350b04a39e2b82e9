#include "engine/io/wording.h"

#include <gtest/gtest.h>

namespace poesy {
namespace {

const std::vector<std::string_view> kKnown{"sigma", "half_width", "distribution"};

TEST(Suggestion, NamesTheClosestWord) {
  EXPECT_EQ(suggestion("sgima", kKnown), "did you mean 'sigma'?");
  EXPECT_EQ(suggestion("half-width", kKnown), "did you mean 'half_width'?");
  EXPECT_EQ(suggestion("distributon", kKnown), "did you mean 'distribution'?");
  EXPECT_EQ(suggestion("mn", std::vector<std::string_view>{"deg", "mm"}), "did you mean 'mm'?");
}

TEST(Suggestion, ListsTheKnownWordsWhenNoneIsClose) {
  EXPECT_EQ(suggestion("color", kKnown), "known: sigma, half_width, distribution");
  EXPECT_EQ(suggestion(std::string(100000, 'x'), kKnown), "known: sigma, half_width, distribution");
  EXPECT_EQ(suggestion("", kKnown), "known: sigma, half_width, distribution");
}

TEST(Suggestion, NeedsACharacterInCommon) {
  const std::vector<std::string_view> coordinates{"x", "y"};
  EXPECT_EQ(suggestion("z", coordinates), "known: x, y");
  EXPECT_EQ(suggestion("", coordinates), "known: x, y");
}

TEST(Suggestion, ShortensLongLists) {
  const std::vector<std::string_view> many(71, "delta");
  const std::string text = suggestion("unlike", many);
  EXPECT_NE(text.find("... (71 in all)"), std::string::npos) << text;
  EXPECT_LT(text.size(), 120u);
}

TEST(Printable, KeepsTextAndReplacesTheRest) {
  EXPECT_EQ(printable("0.5 mm"), "0.5 mm");
  EXPECT_EQ(printable("\xC2\xB5m \xE2\x82\xAC \xF0\x9F\x98\x80"), "\xC2\xB5m \xE2\x82\xAC \xF0\x9F\x98\x80");
  EXPECT_EQ(printable(std::string_view("a\nb\0c\x7F\x1B[", 8)), "a?b?c??[");
  EXPECT_EQ(printable("\xC2\x9B"), "?");  // a control character of two bytes
  EXPECT_EQ(printable("\xFF\xC3-\x80"),
            "?"
            "?-?");                        // not UTF-8
  EXPECT_EQ(printable("\xE2\x82"), "??");  // cut off
}

TEST(Printable, CutsLongTextBetweenCharacters) {
  std::string euros;
  for (int k = 0; k < 100; ++k) euros += "\xE2\x82\xAC";
  EXPECT_EQ(printable(euros), euros.substr(0, 60) + "...");
}

}  // namespace
}  // namespace poesy
