#include "engine/fits/it_grade.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace poesy {
namespace {

/// A row of ISO 286-1:2010, Table 1.
struct PrintedRow {
  double up_to;                    ///< the largest nominal size, mm
  std::array<int, 10> micrometre;  ///< the tolerances of IT5 to IT14
};
const std::vector<PrintedRow> kPrinted{
    {3, {4, 6, 10, 14, 25, 40, 60, 100, 140, 250}},         {6, {5, 8, 12, 18, 30, 48, 75, 120, 180, 300}},
    {10, {6, 9, 15, 22, 36, 58, 90, 150, 220, 360}},        {18, {8, 11, 18, 27, 43, 70, 110, 180, 270, 430}},
    {30, {9, 13, 21, 33, 52, 84, 130, 210, 330, 520}},      {50, {11, 16, 25, 39, 62, 100, 160, 250, 390, 620}},
    {80, {13, 19, 30, 46, 74, 120, 190, 300, 460, 740}},    {120, {15, 22, 35, 54, 87, 140, 220, 350, 540, 870}},
    {180, {18, 25, 40, 63, 100, 160, 250, 400, 630, 1000}}, {250, {20, 29, 46, 72, 115, 185, 290, 460, 720, 1150}},
    {315, {23, 32, 52, 81, 130, 210, 320, 520, 810, 1300}}, {400, {25, 36, 57, 89, 140, 230, 360, 570, 890, 1400}},
    {500, {27, 40, 63, 97, 155, 250, 400, 630, 970, 1550}},
};
const std::vector<double> kSteps{3,   6,   10,  18,  30,   50,   80,   120,  180,  250, 315,
                                 400, 500, 630, 800, 1000, 1250, 1600, 2000, 2500, 3150};

ItGrade grade_of(int number) { return ItGrade{static_cast<int>(ItGrade::it1) + number - 1}; }

/// The tolerance (micrometres) of grade IT`number` (5 to 18) by the standard's formula, before rounding. above, up_to:
/// the range of nominal sizes (mm).
double by_formula(double above, double up_to, int number) {
  const double size = std::sqrt((above == 0.0 ? 1.0 : above) * up_to);
  const double factor = up_to <= 500.0 ? 0.45 * std::cbrt(size) + 0.001 * size : 0.004 * size + 2.1;
  const std::array<double, 6> multiples{7, 10, 16, 25, 40, 64};
  double multiple = 1.0;
  for (; number > 10; number -= 5) multiple *= 10.0;
  return multiple * multiples[static_cast<std::size_t>(number - 5)] * factor;
}

TEST(ItGrades, AreThoseOfThePrintedTable) {
  double above = 0.0;
  for (const PrintedRow& row : kPrinted) {
    for (int number = 5; number <= 14; ++number) {
      const double expected = row.micrometre[static_cast<std::size_t>(number - 5)] * 1e-6;
      EXPECT_DOUBLE_EQ(it_grade_width(row.up_to * 1e-3, grade_of(number)).value(), expected)
          << row.up_to << " IT" << number;
      const double just_above = std::max(above, 1.0) * 1.001e-3;
      EXPECT_DOUBLE_EQ(it_grade_width(just_above, grade_of(number)).value(), expected) << above << " IT" << number;
    }
    above = row.up_to;
  }
}

// The printed values differ from the formula, because the standard rounds them: the formula gives up to 14 % less for
// sizes up to 3 mm, and at most 8.5 % less for larger sizes.
TEST(ItGrades, AreNearTheFormula) {
  double above = 0.0;
  for (const double up_to : kSteps) {
    for (int number = 5; number <= 18; ++number) {
      const double width = it_grade_width(up_to * 1e-3, grade_of(number)).value() * 1e6;
      const double formula = by_formula(above, up_to, number);
      const double share = up_to <= 3.0 ? 0.16 : up_to <= 6.0 ? 0.1 : 0.055;
      EXPECT_NEAR(width, formula, std::max(0.6, share * formula)) << up_to << " IT" << number;
    }
    above = up_to;
  }
}

TEST(ItGrades, HaveTheFinestValues) {
  EXPECT_DOUBLE_EQ(it_grade_width(0.002, ItGrade::it01).value(), 0.3e-6);
  EXPECT_DOUBLE_EQ(it_grade_width(0.5, ItGrade::it0).value(), 6e-6);
  EXPECT_DOUBLE_EQ(it_grade_width(0.063, ItGrade::it1).value(), 2e-6);
  EXPECT_DOUBLE_EQ(it_grade_width(0.15, ItGrade::it2).value(), 5e-6);
  EXPECT_DOUBLE_EQ(it_grade_width(3.0, ItGrade::it4).value(), 68e-6);
  // For nominal sizes up to 500 mm, the standard rounds the formulas of IT01, IT0 and IT1 to preferred numbers.
  double above = 0.0;
  for (std::size_t k = 0; kSteps[k] <= 500.0; ++k) {
    const double size = std::sqrt((k == 0 ? 1.0 : above) * kSteps[k]);
    EXPECT_NEAR(it_grade_width(kSteps[k] * 1e-3, ItGrade::it01).value() * 1e6, 0.3 + 0.008 * size, 0.3);
    EXPECT_NEAR(it_grade_width(kSteps[k] * 1e-3, ItGrade::it0).value() * 1e6, 0.5 + 0.012 * size, 0.4);
    EXPECT_NEAR(it_grade_width(kSteps[k] * 1e-3, ItGrade::it1).value() * 1e6, 0.8 + 0.020 * size, 1.8);
    above = kSteps[k];
  }
}

TEST(ItGrades, BecomeWiderWithGradeAndSize) {
  for (const double up_to : kSteps) {
    for (int number = 2; number <= 18; ++number) {
      EXPECT_GT(it_grade_width(up_to * 1e-3, grade_of(number)), it_grade_width(up_to * 1e-3, grade_of(number - 1)));
    }
  }
  for (std::size_t k = 1; k < kSteps.size(); ++k) {
    for (int number = 1; number <= 18; ++number) {
      EXPECT_GE(it_grade_width(kSteps[k] * 1e-3, grade_of(number)),
                it_grade_width(kSteps[k - 1] * 1e-3, grade_of(number)));
    }
  }
}

TEST(ItGrades, StopWhereTheStandardDoes) {
  EXPECT_FALSE(it_grade_width(0.0, ItGrade::it7));
  EXPECT_FALSE(it_grade_width(-0.01, ItGrade::it7));
  EXPECT_FALSE(it_grade_width(3.1501, ItGrade::it7));
  EXPECT_FALSE(it_grade_width(0.501, ItGrade::it0));
  EXPECT_TRUE(it_grade_width(0.501, ItGrade::it1));
  EXPECT_FALSE(it_grade_width(0.001, ItGrade::it14));
  EXPECT_TRUE(it_grade_width(0.001, ItGrade::it13));
}

TEST(ItGrades, HaveNames) {
  EXPECT_EQ(it_grade_name(ItGrade::it01), "IT01");
  EXPECT_EQ(it_grade_name(ItGrade::it7), "IT7");
  EXPECT_EQ(it_grade_name(ItGrade::it18), "IT18");
}

}  // namespace
}  // namespace poesy
