#include "engine/schema/toml_text.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/input_error.h"

namespace poesy {
namespace {

toml::table parsed(const std::string& text) { return parse_toml(text, "f.toml", "correct it"); }

/// Expects that the text is refused with these words. In `marked`, '^' stands before the mistake.
void expect_refused(std::string_view marked, const std::vector<std::string>& words) {
  const test::Marked wrong(marked);
  test::expect_input_error([&] { parsed(wrong.text); }, {"f.toml", wrong.line, wrong.column}, words);
}

TEST(ParseToml, RefusesNumbersThatAreTooSmallToBeToldFromZero) {
  expect_refused("[solver]\nshare = ^1e-999\n", {"share is 1e-999, which is too small to be told from 0"});
  expect_refused("share = ^-1_0.5E-4_00 # 0", {"share is -1_0.5E-4_00,"});
  expect_refused("a.b = { c = 0.0, share = ^+3e-400}", {"share is +3e-400,"});
  expect_refused("list = [0.0,\r\n  1.5, [^7e-330]]\r\n", {"list is 7e-330,"});
  expect_refused("share = ^0." + std::string(90, '0') + "1e-250", {"share is 0.000"});
}

TEST(ParseToml, CountsColumnsInCharacters) {
  EXPECT_EQ(test::refusal_of([] { parsed("a = { \"\xC3\xA4\" = \"\xE2\x82\xAC\", b = 1e-999 }"); }),
            "f.toml:1:22: b is 1e-999, which is too small to be told from 0; write 0, or a number from 1e-307 on");
}

TEST(ParseToml, TakesEveryZeroAndTheSmallestNumbers) {
  for (const std::string zero : {"0.0", "-0.0", "0e5", "0.000_0e-12", "+0e-999", "1e-307", "5e-324"}) {
    EXPECT_TRUE(parsed("share = " + zero)["share"].is_floating_point()) << zero;
  }
  EXPECT_EQ(parsed("text = \"1e-999\" # 1e-999")["text"].value<std::string>(), "1e-999");
}

TEST(ParseToml, RefusesNumbersThatAreTooLarge) { expect_refused("share = 1e999^", {"1e999"}); }

TEST(ParseToml, RefusesLongLinesButNotManyLines) {
  expect_refused("a = 1\n^#" + std::string(16384, ' '), {"longer than 16384 bytes"});
  EXPECT_EQ(parsed("a = 1\n#" + std::string(16383, ' ') + std::string(100000, '\n') + "b = 2").size(), 2u);
}

/// Tables nested as deeply as one line allows, in a header and again in a key.
TEST(ParseToml, LooksIntoTheDeepestTables) {
  std::string dots = "a";
  for (int k = 0; k < 8180; ++k) dots += ".a";
  expect_refused("[" + dots + "]\n" + dots + " = ^1e-999", {"a is 1e-999"});
}

TEST(ParseToml, NamesThePlaceOfAnOpenQuote) {
  const std::vector<std::string> on_line{
      "the text that begins here with \" is not closed on its line; write \" at its end"};
  expect_refused("a = 1\nb = ^\"text\nc = 2\n", on_line);
  expect_refused("b = ^\"text", on_line);
  expect_refused("b = [\"a\", \"b\", ^\"c]\nd = 1\n", on_line);
  expect_refused("b = \"a\\\"b\"\nc = ^\"a\\\"\n", on_line);
  expect_refused("# it's \"\nb = ^\"x # y\n", on_line);
  expect_refused("b = \"\"\nc = ^\"text\n", on_line);
  expect_refused("b = ^'text\nc = 'd'\n", {"begins here with ' is not closed on its line"});
  expect_refused("b = ^\"\"\"text\nc = 1\nd = \"\"\n", {"with \"\"\" is not closed up to the end of the file"});
  expect_refused("a = \"\"\"x\n\"y\"\"\"\"\nb = ^'''text\n\"\"\"\n",
                 {"with ''' is not closed up to the end of the file"});
}

TEST(ParseToml, SaysThatALineHasAQuoteTooMany) {
  const std::vector<std::string> too_many{"the line has a quote too many, or one is missing before this place"};
  expect_refused("a = [\"1 mm, \"^2 mm\"]\n", too_many);
  expect_refused("a = t^ext\"\n", too_many);
}

TEST(ParseToml, NamesMissingAndTypographicQuotes) {
  expect_refused("[poses]\nselect = ^boundary # where", {"boundary is a text without quotes", "write \"boundary\""});
  expect_refused("list = [\"a\", ^gap]\r\n", {"gap is a text without quotes"});
  expect_refused("select = ^\u201cboundary\u201d", {"\u201c is a typographic quote", "write the plain quote"});
  for (const std::string word : {"interior", "normal", "true_ones", "file"}) {
    EXPECT_NE(test::refusal_of([&] { parsed("a = " + word); }).find(word + " is a text without quotes"),
              std::string::npos);
  }
  EXPECT_NE(test::refusal_of([] { parsed("a = True"); }).find("write true"), std::string::npos);
}

TEST(ParseToml, KeepsOtherReasonsBesideValues) {
  for (const std::string value : {"true", "false", "nan", "-inf"}) {
    EXPECT_NE(test::refusal_of([&] { parsed("a = " + value + "\na = " + value); }).find("redefine"), std::string::npos);
  }
}

TEST(ParseToml, KeepsOtherReasonsBesideTypographicQuotes) {
  for (const std::string text : {"a = \"\u201cb\u201d\" 3", "a = 3,5 # \u201cb\u201d"}) {
    EXPECT_EQ(test::refusal_of([&] { parsed(text); }).find("typographic"), std::string::npos) << text;
  }
}

/// An open quote elsewhere in the text is not the reason of the mistake.
TEST(ParseToml, KeepsOtherReasonsBesideOpenQuotes) {
  expect_refused("[a^\nb = 1\nc = \"text\n", {"this is not TOML: parsing table header"});
  expect_refused("a = \"it's\" # don't\n[b^\n", {"this is not TOML: parsing table header"});
}

TEST(ParseToml, SaysWhatIsNotToml) {
  EXPECT_EQ(test::refusal_of([] { parsed("[a\n"); }),
            "f.toml:1:3: this is not TOML: parsing table header: expected ']', saw '\\n'; correct it");
}

}  // namespace
}  // namespace poesy
