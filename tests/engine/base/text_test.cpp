#include "engine/base/text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace poesy {
namespace {

const std::vector<std::string_view> kKnown{"sigma", "half_width", "distribution"};

using Lines = std::vector<std::string>;

TEST(Wrapped, BreaksBetweenWordsAndNowhereElse) {
  EXPECT_EQ(wrapped("one two three", 7), (Lines{"one two", "three"}));
  EXPECT_EQ(wrapped("unbreakable word", 4), (Lines{"unbreakable", "word"}));
  EXPECT_EQ(wrapped("", 4), Lines());
}

TEST(Wrapped, KeepsNumbersTogether) {
  EXPECT_EQ(wrapped("up to 12 000 solves", 8), (Lines{"up to", "12 000", "solves"}));
  EXPECT_EQ(wrapped("at 5 % of", 4), (Lines{"at", "5 %", "of"}));
}

TEST(Wrapped, CountsCharactersNotBytes) { EXPECT_EQ(wrapped("5 \xC2\xB5m", 4), Lines{"5 \xC2\xB5m"}); }

TEST(Wrapped, HasAWidthOfItsOwnForTheFirstLine) {
  EXPECT_EQ(wrapped("a b c d e f", 5, 1), (Lines{"a", "b c d", "e f"}));
  EXPECT_EQ(wrapped("a b c d e f", 1, 5), (Lines{"a b c", "d", "e", "f"}));
}

TEST(Suggestion, NamesTheClosestWord) {
  EXPECT_EQ(suggestion("sgima", kKnown), "did you mean 'sigma'?");
  EXPECT_EQ(suggestion("half-width", kKnown), "did you mean 'half_width'?");
  EXPECT_EQ(suggestion("distributon", kKnown), "did you mean 'distribution'?");
  EXPECT_EQ(suggestion("Sigma", kKnown), "did you mean 'sigma'?");
  EXPECT_EQ(suggestion("X", std::vector<std::string_view>{"z", "x"}), "did you mean 'x'?");
  EXPECT_EQ(suggestion("dz", std::vector<std::string_view>{"z", "deviation_z"}), "did you mean 'deviation_z'?");
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

/// A code point encoded as UTF-8 in `length` bytes, even if that is not its valid (shortest) form.
std::string written_in(std::size_t length, std::uint32_t code) {
  constexpr unsigned char kLead[] = {0, 0, 0xC0, 0xE0, 0xF0};
  std::string bytes(length, '\0');
  for (std::size_t k = length; k-- > 1; code >>= 6U) bytes[k] = static_cast<char>(0x80U | (code & 0x3FU));
  bytes[0] = static_cast<char>(kLead[length] | code);
  return bytes;
}

/// Tries each code point in each number of bytes that can hold its bits. At most one of these encodings is valid.
TEST(Printable, TakesEachCodePointInItsShortestFormAlone) {
  constexpr std::uint32_t kBeyond[] = {0, 0, 1U << 11U, 1U << 16U, 1U << 21U};
  for (std::size_t length = 2; length <= 4; ++length) {
    for (std::uint32_t code = 0; code < kBeyond[length]; ++code) {
      const std::size_t form = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
      const bool has_form = code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
      const bool turns = code == 0x61C || code == 0x200E || code == 0x200F || (code >= 0x202A && code <= 0x202E) ||
                         (code >= 0x2066 && code <= 0x2069);
      const bool control = (code >= 0x80 && code < 0xA0) || code == 0x2028 || code == 0x2029 || turns;
      const std::string bytes = written_in(length, code);
      const std::string expected = form != length || !has_form ? std::string(length, '?') : control ? "?" : bytes;
      ASSERT_EQ(printable(bytes), expected) << length << " bytes, code point " << code;
    }
  }
}

TEST(ShellCommand, IsOneLineThatAShellTakesApartAgain) {
  EXPECT_EQ(shell_command({"poesy", "run", "a b.toml", "it's"}), R"(poesy run 'a b.toml' 'it'\''s')");
  EXPECT_EQ(shell_command({"\xC3\xA4.toml"}), "'\xC3\xA4.toml'");
  EXPECT_EQ(shell_command({"a\nb'\\\xE2\x80\xAE"}), R"($'a\x0ab\'\\\xe2\x80\xae')");
}

TEST(FormulaSign, IsSeenBehindWhatIsNotSeen) {
  for (const char* sign : {"=", "+", "-", "@", "\xEF\xBC\x9D", "\xEF\xBC\x8B", "\xEF\xBC\x8D", "\xEF\xBC\xA0"}) {
    EXPECT_EQ(formula_sign(std::string(sign) + "1"), sign);
    EXPECT_EQ(formula_sign(" \xC2\xA0\xE2\x80\x8B\xEF\xBB\xBF" + std::string(sign)), sign);
    EXPECT_EQ(formula_sign("a" + std::string(sign)), "");
  }
  EXPECT_EQ(formula_sign(""), "");
  EXPECT_EQ(formula_sign("\xFF=1"), "");
}

TEST(Either, JoinsTheLastByOr) {
  const std::vector<std::string_view> words{"a", "b", "c"};
  EXPECT_EQ(either(words), "a, b or c");
  EXPECT_EQ(either(std::span(words).first(2)), "a or b");
  EXPECT_EQ(either(std::span(words).first(1)), "a");
}

TEST(Printable, RefusesBytesThatBeginNoCharacter) {
  for (unsigned byte = 0x80; byte <= 0xFF; ++byte) {
    EXPECT_EQ(printable(std::string(1, static_cast<char>(byte)) + "a"), "?a") << byte;
  }
  EXPECT_EQ(printable("\xF8\x88\x80\x80\x80"), "?????");  // five bytes
  EXPECT_EQ(printable("\xF0\x9F\x98"), "???");            // cut off
}

TEST(Printable, CutsLongTextBetweenCharacters) {
  std::string euros;
  for (int k = 0; k < 100; ++k) euros += "\xE2\x82\xAC";
  EXPECT_EQ(printable(euros), euros.substr(0, 60) + "...");
}

}  // namespace
}  // namespace poesy
