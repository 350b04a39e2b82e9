#include "engine/fits/fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace poesy {
namespace {

void expect_limits(const std::string& text, double lower, double upper) {
  const SizeLimits found = size_limits(text);
  EXPECT_NEAR(found.lower * 1e6, lower, 1e-9) << text;
  EXPECT_NEAR(found.upper * 1e6, upper, 1e-9) << text;
}

/// The message of the exception that `read` throws for this text.
template <class Read>
std::string problem(const Read& read, const std::string& text) {
  try {
    read(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

// Limits from ISO 286-2:2010, Tables 6 and 17 to 22. The deviations are in micrometres.
TEST(Fits, HaveTheLimitsOfThePrintedTables) {
  expect_limits("217 h6", -29, 0);
  expect_limits("20 H7", 0, 21);
  expect_limits("3 g6", -8, -2);
  expect_limits("6 g6", -12, -4);
  expect_limits("8 g6", -14, -5);
  expect_limits("20 f7", -41, -20);
  expect_limits("50 f7", -50, -25);
  expect_limits("80 e8", -106, -60);
  expect_limits("100 d9", -207, -120);
  expect_limits("180 g6", -39, -14);
  expect_limits("250 f8", -122, -50);
  expect_limits("315 e9", -240, -110);
  expect_limits("400 g5", -43, -18);
  expect_limits("500 d11", -630, -230);
  expect_limits("500 H18", 0, 9700);
}

TEST(Fits, ReadTheWaysOfWritingThem) {
  expect_limits(" 217h6 ", -29, 0);
  expect_limits("217.0  h6", -29, 0);
  expect_limits("21.7 cm h6", -29, 0);
  expect_limits("1 in H7", 0, 21);
  expect_limits("10 h01", -0.4, 0);
  expect_limits("10 h0", -0.6, 0);
}

// Computed by hand from the tables (micrometres). Example: the variance of 20 H7/g6 is (21^2 + 13^2) / 36.
TEST(Fits, HaveTheClearanceOfHoleAndShaft) {
  struct Row {
    const char* text;
    double least, most, mean, sd;
  };
  const std::vector<Row> rows{{"20 H7/g6", 7, 41, 24, 4.116363011742823},
                              {"20 H7/h6", 0, 34, 17, 4.116363011742823},
                              {"20 H7/f7", 20, 62, 41, 4.949747468305833},
                              {"8 H7/g6", 5, 29, 17, 2.9154759474226504},
                              {"50 H7 / g6", 9, 50, 29.5, 4.94694069321861}};
  for (const Row& row : rows) {
    const Fit found = fit(row.text);
    EXPECT_NEAR(found.least * 1e6, row.least, 1e-9) << row.text;
    EXPECT_NEAR(found.most * 1e6, row.most, 1e-9) << row.text;
    EXPECT_NEAR(found.mean * 1e6, row.mean, 1e-9) << row.text;
    EXPECT_NEAR(std::sqrt(found.variance) * 1e6, row.sd, 1e-9) << row.text;
  }
}

TEST(Fits, StepsEndAtTheirLargestSize) {
  for (const auto& [size, lower] : {std::pair{"10", -14.0}, {"10.001", -17.0}, {"120", -34.0}, {"120.001", -39.0}}) {
    EXPECT_NEAR(size_limits(std::string(size) + " g6").lower * 1e6, lower, 1e-9) << size;
  }
}

TEST(Fits, SayWhatTheyCannotRead) {
  const std::vector<std::pair<std::string, std::string>> texts{
      {"h6", "'h6' does not begin with a nominal size above zero"},
      {"-8 h6", "'-8 h6' does not begin with a nominal size above zero"},
      {"0 h6", "'0 h6' does not begin with a nominal size above zero"},
      {"501 h6", "'501 h6' is beyond 500 mm, the largest nominal size of this table"},
      {"8 deg h6",
       "'8 deg h6' has 'deg' where a unit of length may be (m, cm, mm, um, in, mil, thou); without one the size is in "
       "mm"},
      {"8", "'8' has no zone of this table: it knows holes H and shafts d, e, f, g, h, such as H7 or g6"},
      {"8 k6", "'8 k6' has no zone of this table: it knows holes H and shafts d, e, f, g, h, such as H7 or g6"},
      {"8 G7", "'8 G7' has no zone of this table: it knows holes H and shafts d, e, f, g, h, such as H7 or g6"},
      {"8 h", "'8 h' has no grade from 01 to 18 after the letter h"},
      {"8 h19", "'8 h19' has no grade from 01 to 18 after the letter h"},
      {"8 h06", "'8 h06' has no grade from 01 to 18 after the letter h"},
      {"8 h6x", "'8 h6x' has no grade from 01 to 18 after the letter h"},
      {"0.9 h14", "'0.9 h14' has the grade IT14, which ISO 286-1 does not have for this size"},
      {"8 H7/g6", "'8 H7/g6' is a fit of two parts; write the zone of one of them, such as H7 or g6"}};
  for (const auto& [text, expected] : texts) EXPECT_EQ(problem(size_limits, text), expected);
  EXPECT_EQ(problem(fit, "8 H7"), "'8 H7' is not a fit; write the zones of hole and shaft, such as 8 H7/g6");
  EXPECT_EQ(problem(fit, "8 g6/H7"), "'8 g6/H7' is not a hole H before a shaft d, e, f, g or h");
  EXPECT_EQ(problem(fit, "8 H7/H7"), "'8 H7/H7' is not a hole H before a shaft d, e, f, g or h");
}

}  // namespace
}  // namespace poesy
