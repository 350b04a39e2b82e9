#include "engine/report/table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "engine/report/display.h"

namespace poesy {
namespace {

Cell number(std::string text, double value) { return {std::move(text), value}; }

Table example() {
  return {
      .name = "example",
      .caption = "What is seen here",
      .columns =
          {{.name = "error", .heading = "error", .unit = "", .kind = Column::Kind::text},
           {.name = "effect", .heading = "effect", .unit = "mm", .kind = Column::Kind::number},
           {.name = "other", .heading = "some other", .unit = "deg", .kind = Column::Kind::number, .dispensable = 2},
           {.name = "other_high", .heading = "high", .unit = "deg", .kind = Column::Kind::number, .dispensable = 2},
           {.name = "last", .heading = "last", .unit = "", .kind = Column::Kind::text, .dispensable = 1}},
      .rows = {{{"a_long_name", {}}, number("12.5", 12.5), number("1e-05", 1e-5), {"-", {}}, {"yes", {}}},
               {{"b", {}}, number("0.25", 0.25), number("3", 3.0), number("4 000", 4000.0), {"no", {}}}},
      .notes = {"words that a reader needs below it"}};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::size_t longest(const std::string& text) {
  std::size_t length = 0;
  for (const std::string& line : lines_of(text)) length = std::max(length, line.size());
  return length;
}

TEST(TextTable, PutsNumbersUnderEachOtherByTheirPoints) {
  EXPECT_EQ(text_of(example(), kUnlimitedWidth),
            "What is seen here\n"
            "                      some\n"
            "error        effect  other   high  last\n"
            "               [mm]  [deg]  [deg]\n"
            "a_long_name   12.5   1e-05      -  yes\n"
            "b              0.25  3      4 000  no\n"
            "words that a reader needs below it\n");
}

TEST(TextTable, LeavesOutWhatCanBeDispensedWithMost) {
  EXPECT_EQ(text_of(example(), 38),
            "What is seen here\n"
            "error        effect  last\n"
            "               [mm]\n"
            "a_long_name   12.5   yes\n"
            "b              0.25  no\n"
            "words that a reader needs below it\n"
            "(no room for some other: a wider\n"
            "terminal shows more)\n");
  EXPECT_NE(text_of(example(), 38, "a lens").find("(no room for some other: a lens shows\nmore)\n"), std::string::npos);
}

TEST(TextTable, KeepsToTheWidthWhereNamesAllow) {
  const std::size_t whole = longest(text_of(example(), kUnlimitedWidth));
  for (std::size_t width = 19; width <= whole + 5; ++width) {
    const std::string text = text_of(example(), width);
    EXPECT_LE(longest(text), width) << text;
    EXPECT_NE(text.find("a_long_name"), std::string::npos) << text;
    EXPECT_EQ(text.find(" \n"), std::string::npos) << text;
    EXPECT_EQ(width >= 39, text.find("(no room") == std::string::npos) << text;
  }
}

TEST(TextTable, NeverCutsWhatIsIndispensable) {
  const std::vector<std::string> lines = lines_of(text_of(example(), 1));
  EXPECT_NE(std::ranges::find(lines, "a_long_name   12.5"), lines.end());
  EXPECT_NE(std::ranges::find(lines, "b              0.25"), lines.end());
}

TEST(TextTable, CountsCharactersNotBytes) {
  Table table = example();
  table.rows[0][0].text = "a_long_n\xC3\xA4me";
  EXPECT_EQ(lines_of(text_of(table, kUnlimitedWidth))[4].size(),
            lines_of(text_of(example(), kUnlimitedWidth))[4].size() + 1);
}

TEST(TextTable, BreaksNoNumber) {
  Table table = example();
  table.notes = {"from 1 000 to 8 000 samples, 95 % of them"};
  const std::string text = text_of(table, 19);
  EXPECT_NE(text.find("\nfrom 1 000 to 8 000\nsamples, 95 % of\nthem\n"), std::string::npos) << text;
}

TEST(TextTable, WithoutRowsIsItsCaptionAndNotes) {
  Table table = example();
  table.rows.clear();
  EXPECT_EQ(text_of(table, kUnlimitedWidth), "What is seen here\nwords that a reader needs below it\n");
}

TEST(TextTable, SeparatesTablesByAnEmptyLine) {
  const std::string one = text_of(example(), 80);
  EXPECT_EQ(text_of(std::vector<Table>{example(), example()}, 80), one + "\n" + one);
}

TEST(TextTable, ShowsNoControlCharacterOfANameOrNote) {
  const Table table{.name = "t",
                    .caption = "a\x1b[1m",
                    .columns = {{"error", "error", "", Column::Kind::text, 0}},
                    .rows = {{{"delta\x1b]0;x\x07", std::nullopt}}},
                    .notes = {"b\x1b[2J"}};
  EXPECT_EQ(text_of(table, kUnlimitedWidth), "a?[1m\nerror\ndelta?]0;x?\nb?[2J\n");
}

TEST(Fill, GivesEachPositionARowWithTheCellsOfTheColumns) {
  const std::vector<std::string> names{"a", "b", "c"};
  Table table{.name = "t", .caption = "c", .columns = {}};
  fill(table, {2, 0},
       {{text_column("name", "name"), [&](std::size_t n) { return text_cell(names[n]); }},
        {number_column("n", "n"), [](std::size_t n) { return count_cell(n); }}});
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.columns[1].name, "n");
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0].text, "c");
  EXPECT_EQ(table.rows[1][1].value, 0.0);
  EXPECT_EQ(positions(3), (std::vector<std::size_t>{0, 1, 2}));
}

}  // namespace
}  // namespace poesy
