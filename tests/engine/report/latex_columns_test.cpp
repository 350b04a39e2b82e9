#include "engine/report/latex_columns.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/report/display.h"
#include "engine/report/latex.h"
#include "engine/report/latex_text.h"

namespace poesy {
namespace {

/// A table with one row. Number columns have the cell "0.123456", text columns their name.
Table table_of(std::vector<Column> columns) {
  Table table{.name = "some", .caption = "Some", .columns = std::move(columns)};
  table.rows.emplace_back();
  for (const Column& column : table.columns) {
    const bool is_number = column.kind == Column::Kind::number;
    table.rows.back().push_back(is_number ? number_cell(0.123456, 6) : text_cell(column.name));
  }
  return table;
}

std::vector<std::string> names(const Table& table) {
  std::vector<std::string> all;
  for (const Column& column : table.columns) all.push_back(column.name);
  return all;
}

double width_of(const std::vector<ColumnLayout>& layout) {
  double width = kColumnGap * static_cast<double>(layout.size() - 1);
  for (const ColumnLayout& one : layout) width += one.width;
  return width;
}

/// The expected values are the widths (pt) that LaTeX gives to this text in Computer Modern Roman at 8 pt.
TEST(LatexWidth, IsThatOfLatex) {
  constexpr double kRounding = 0.1;  // each character's width is rounded up to a tenth of a point
  EXPECT_NEAR(latex_width("0"), 4.25, kRounding);
  EXPECT_NEAR(latex_width("m"), 7.08, kRounding);
  EXPECT_NEAR(latex_number_width("-1"), 10.86, 2 * kRounding);
  EXPECT_NEAR(latex_number_width("1e+02"), 27.31, 3 * kRounding);
  EXPECT_NEAR(latex_number_width("1e-02"), 33.08, 4 * kRounding);
}

TEST(LatexColumns, AllStayWhereThereIsRoom) {
  const Table table = table_of({text_column("error", "error"), number_column("effect", "effect", "mm", 5)});
  EXPECT_EQ(names(fitted(table, 85.0)), names(table));
}

TEST(LatexColumns, LimitsUnitsAndIntervalsStayLongest) {
  const Table table = table_of({text_column("response", "response"), number_column("yield", "yield", "%"),
                                number_column("low", "low", "%", 9), number_column("high", "high", "%", 9),
                                number_column("rejects", "rejects"), number_column("machines", "machines", "", 2),
                                number_column("limit", "limit", "", 3), text_column("unit", "unit", 3)});
  const double all = 25.4 / 72.27 * width_of(layout_of(table, 400.0));
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(fitted(table, all)), (Names{"response", "yield", "low", "high", "rejects", "limit", "unit"}));
  EXPECT_EQ(names(fitted(table, all - 15.0)), (Names{"response", "yield", "low", "high", "limit", "unit"}));
  EXPECT_EQ(names(fitted(table, 40.0)), (Names{"response", "yield"}));
}

TEST(LatexColumns, AnIntervalGoesWithItsValue) {
  const Table table = table_of({text_column("error", "error"), number_column("gap", "gap"),
                                number_column("gap_low", "low"), number_column("x", "x", "", 1),
                                number_column("x_low", "low", "", 1), number_column("x_high", "high", "", 1)});
  EXPECT_EQ(names(fitted(table, 50.0)), (std::vector<std::string>{"error", "gap", "gap_low"}));
}

TEST(LatexColumns, AUnitGoesWithADispensableNumber) {
  const Table table = table_of({text_column("part", "part"), number_column("cost", "cost"),
                                number_column("share", "share of the whole cost"),
                                number_column("sigma", "sigma", "", 4), text_column("unit", "unit", 4)});
  EXPECT_EQ(names(fitted(table, 40.0)), (std::vector<std::string>{"part", "cost", "share"}));
}

TEST(LatexColumns, AUnitGoesWithTheLastNumberThatNeedsIt) {
  const Table table = table_of({text_column("error", "error"), number_column("effect", "effect", "mm"),
                                number_column("index", "index", "mm/unit"), number_column("low", "low", "mm/unit", 1),
                                number_column("high", "high", "mm/unit", 1), text_column("unit", "unit")});
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(fitted(table, 80.0)), (Names{"error", "effect", "index", "low", "high", "unit"}));
  EXPECT_EQ(names(fitted(table, 35.0)), (Names{"error", "effect"}));
}

TEST(LatexColumns, AUnitBeforeItsNumbersStays) {
  const Table table = table_of({text_column("response", "response"), text_column("unit", "unit"),
                                number_column("mean", "mean"), number_column("std", "standard deviation"),
                                number_column("rms", "rms"), number_column("max", "largest of all")});
  EXPECT_EQ(names(fitted(table, 60.0)), (std::vector<std::string>{"response", "unit", "mean", "std"}));
}

TEST(LatexColumns, IntervalsHaveTheUnitOfTheirValueIfThereIsLittleRoom) {
  Table table = table_of({text_column("error", "error"), number_column("index", "index", "mm/unit"),
                          number_column("low", "low", "mm/unit"), number_column("high", "high", "mm/unit")});
  for (std::size_t c = 1; c < table.columns.size(); ++c) table.rows[0][c] = number_cell(2.5, 2);
  const double all = 25.4 / 72.27 * width_of(layout_of(table, 400.0)) + 1.0;
  EXPECT_EQ(fitted(table, all + 1.0).columns[2].unit, "mm/unit");
  const Table narrow = fitted(table, all - 10.0);
  EXPECT_EQ(names(narrow), names(table));
  EXPECT_EQ(narrow.columns[2].unit, "");
  EXPECT_EQ(narrow.columns[1].unit, "mm/unit");
}

TEST(LatexColumns, AHeadingHasTwoLinesIfItIsWiderThanTheCells) {
  const Table table =
      table_of({text_column("error", "error"), number_column("removable", "removable by all calibrations", "%")});
  const ColumnLayout layout = layout_of(table, 85.0)[1];
  EXPECT_EQ(layout.upper, "removable by all");
  EXPECT_EQ(layout.lower, "calibrations [\\%]");
  EXPECT_DOUBLE_EQ(layout.width, latex_width("removable by all"));
  EXPECT_NE(latex_of(table, 85.0).find(" & removable by all \\\\\nerror & calibrations [\\%] \\\\\n"),
            std::string::npos);
}

TEST(LatexColumns, WordsAreBrokenIntoLinesBeforeAColumnIsLeftOut) {
  Table table = table_of({text_column("error", "error"), text_column("what", "what it is", 1)});
  table.rows[0][1] = text_cell("length of the rod between the ball at the arm and the ball at the platform of a limb");
  EXPECT_EQ(names(fitted(table, 85.0)), names(table));
  const std::vector<ColumnLayout> layout = layout_of(table, 85.0);
  EXPECT_FALSE(layout[0].is_paragraph);
  EXPECT_TRUE(layout[1].is_paragraph);
  EXPECT_LE(width_of(layout), 85.0 * 72.27 / 25.4);
  const std::string text = latex_of(table, 85.0);
  EXPECT_TRUE(text.starts_with("% needs \\usepackage{array,booktabs}\n"));
  EXPECT_FALSE(layout_of(table, 170.0)[1].is_paragraph);
}

TEST(LatexColumns, AFileNamesTheColumnsThatDoNotFit) {
  std::vector<Column> columns{text_column("error", "error")};
  for (int n = 1; n <= 9; ++n) columns.push_back(number_column("n" + std::to_string(n), "n" + std::to_string(n)));
  const Table table = table_of(columns);
  const std::string text = latex_of(table, 85.0);
  EXPECT_NE(text.find("% 85 mm have no room for: n6, n7, n8, n9\n"), std::string::npos);
  EXPECT_EQ(latex_of(table, 170.0).find("no room"), std::string::npos);
  EXPECT_NE(latex_of(table, 170.0).find("\\begin{table*}"), std::string::npos);  // spans both columns of a page
}

}  // namespace
}  // namespace poesy
