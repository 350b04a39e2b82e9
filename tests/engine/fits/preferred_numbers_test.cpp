#include "engine/fits/preferred_numbers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace poesy {
namespace {

using enum PreferredSeries;

/// The series R10 from ISO 3:1973, Table 1.
constexpr std::array kPrinted{1.00, 1.25, 1.60, 2.00, 2.50, 3.15, 4.00, 5.00, 6.30, 8.00, 10.00};

TEST(PreferredNumbers, AreThoseOfTheStandard) {
  for (std::size_t k = 0; k + 1 < kPrinted.size(); ++k) {
    EXPECT_EQ(preferred_at_most(kPrinted[k], r10), kPrinted[k]);
    EXPECT_EQ(preferred_at_least(kPrinted[k], r10), kPrinted[k]);
    EXPECT_EQ(preferred_at_most(std::nextafter(kPrinted[k + 1] * (1.0 - 1e-9), 0.0), r10), kPrinted[k]);
    EXPECT_EQ(preferred_at_least(kPrinted[k] * (1.0 + 1e-9), r10), kPrinted[k + 1]);
  }
}

/// Each preferred number is within 1.3 % of a power of the root of ten (R5: fifth root), and all numbers of R5 and R10
/// are also in R20.
TEST(PreferredNumbers, AreNearPowersOfARootOfTen) {
  for (const auto& [series, count] : {std::pair(r5, 5), std::pair(r10, 10), std::pair(r20, 20)}) {
    double number = 1.0;
    for (int k = 0; k <= count; ++k) {
      EXPECT_NEAR(number / std::pow(10.0, static_cast<double>(k) / count), 1.0, 0.013) << name(series) << " " << k;
      EXPECT_EQ(preferred_at_most(number, r20), number);
      number = preferred_at_least(number * 1.001, series);
    }
    EXPECT_GT(number, 10.0);
  }
}

TEST(PreferredNumbers, ReachAllDecades) {
  EXPECT_EQ(preferred_at_most(0.00399, r10), 0.00315);
  EXPECT_EQ(preferred_at_most(0.0999, r5), 0.063);
  EXPECT_EQ(preferred_at_least(0.0631, r5), 0.1);
  EXPECT_EQ(preferred_at_most(0.1 * (1.0 - 1e-15), r20), 0.1);
  EXPECT_EQ(preferred_at_most(2.4e5, r20), 2.24e5);
}

TEST(PreferredNumbers, HaveNames) {
  EXPECT_EQ(find_preferred_series("R20"), r20);
  EXPECT_EQ(find_preferred_series("R40"), std::nullopt);
}

}  // namespace
}  // namespace poesy
