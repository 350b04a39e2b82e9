#include "engine/report/html/printed_number.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/report/display.h"

namespace poesy {
namespace {

std::vector<std::string> texts(const std::vector<Cell>& column, int digits = 0) {
  std::vector<std::string> list;
  for (const PrintedNumber& one : printed_numbers(column, digits)) list.push_back(one.text);
  return list;
}

TEST(PrintedNumbers, HaveTheZerosThatAreDigitsOfTheNumber) {
  EXPECT_EQ(texts({number_cell(0.4913), number_cell(0.45001), number_cell(0.5), number_cell(2.0)}),
            (std::vector<std::string>{"0.4913", "0.4500", "0.5000", "2.000"}));
  // 99.755 has five digits, so that the difference from 100 % has three.
  EXPECT_EQ(texts({percent_cell(0.99755), percent_cell(0.078196), percent_cell(0.5), percent_cell(0.0)}, 3),
            (std::vector<std::string>{"99.755", "7.82", "50.0", "0"}));
}

TEST(PrintedNumbers, OfWholeColumnsAreExact) {
  EXPECT_EQ(texts({number_cell(1.0), number_cell(25.0)}), (std::vector<std::string>{"1", "25"}));
  EXPECT_EQ(texts({count_cell(75000), count_cell(3)}), (std::vector<std::string>{"75 000", "3"}));
}

TEST(PrintedNumbers, AreWrittenOneWayHoweverLargeTheyAre) {
  EXPECT_EQ(texts({number_cell(54351.0), number_cell(-2.2846e-5)}),
            (std::vector<std::string>{"54 350", "−0.00002285"}));
  EXPECT_EQ(texts({number_cell(4.53e-9, 3)}), (std::vector<std::string>{"4.53\u00a0×\u00a010⁻⁹"}));
  EXPECT_EQ(texts({number_cell(1.5e12, 2)}), (std::vector<std::string>{"1.5\u00a0×\u00a010¹²"}));
}

TEST(PrintedNumbers, SayHowMuchStandsBehindTheirWholePart) {
  const std::vector<Cell> column{number_cell(12.5), number_cell(0.125), text_cell("rounding"), number_cell(3.0)};
  const std::vector<PrintedNumber> printed = printed_numbers(column);
  EXPECT_EQ(printed[0].text, "12.5");
  EXPECT_EQ(printed[0].tail, 2U);
  EXPECT_EQ(printed[1].tail, 4U);
  EXPECT_FALSE(printed[2].is_number);
  EXPECT_EQ(printed[2].text, "rounding");
  EXPECT_EQ(printed[3].text, "3.00");
}

}  // namespace
}  // namespace poesy
