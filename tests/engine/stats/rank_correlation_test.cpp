#include "engine/stats/rank_correlation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace poesy {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(RankCorrelation, IsOneForWhateverOnlyGrows) {
  std::vector<double> x;
  std::vector<double> grows;
  std::vector<double> falls;
  for (int n = 0; n < 50; ++n) {
    x.push_back(std::sin(n) * n);
    grows.push_back(std::exp(0.3 * x.back()));
    falls.push_back(-std::cbrt(x.back()));
  }
  EXPECT_DOUBLE_EQ(rank_correlation(x, grows), 1.0);
  EXPECT_DOUBLE_EQ(rank_correlation(x, falls), -1.0);
}

/// Computed by hand: x has the ranks 3.5, 1, 5, 3.5, 6, 2 and y has 2, 5, 3.5, 3.5, 1, 6. The squared deviations from
/// 3.5 add up to 17 for both.
TEST(RankCorrelation, SharesRanksAmongEqualValues) {
  const std::array x{0.3, -1.2, 2.5, 0.3, 4.0, -0.7};
  const std::array y{1.0, 5.0, 2.0, 2.0, 0.5, 7.0};
  EXPECT_NEAR(rank_correlation(x, y), -13.75 / 17.0, 1e-15);
}

TEST(RankCorrelation, LeavesOutWhatIsNotKnown) {
  const std::array x{1.0, kNaN, 2.0, 3.0, 4.0};
  const std::array y{2.0, -9.0, 3.0, kNaN, 5.0};
  EXPECT_DOUBLE_EQ(rank_correlation(x, y), 1.0);
}

TEST(RankCorrelation, IsNotKnownOfTwoPairsOrOfEqualValues) {
  const std::array two{1.0, 2.0};
  EXPECT_TRUE(std::isnan(rank_correlation(two, two)));
  const std::array grows{1.0, 2.0, 3.0};
  const std::array same{5.0, 5.0, 5.0};
  EXPECT_TRUE(std::isnan(rank_correlation(grows, same)));
  EXPECT_TRUE(std::isnan(rank_correlation(same, grows)));
}

TEST(KendallTau, IsOneWhereAllAgree) {
  const std::array x{3.0, -1.0, 0.5, 8.0};
  const std::array grows{30.0, 2.0, 5.0, 31.0};
  const std::array falls{-3.0, 1.0, -0.5, -8.0};
  EXPECT_EQ(kendall_tau(x, grows), 1.0);
  EXPECT_EQ(kendall_tau(x, falls), -1.0);
}

/// Computed by hand: x orders nine of the ten pairs and y orders seven.
TEST(KendallTau, LeavesOutWhatIsEqual) {
  const std::array x{5.0, 4.0, 3.0, 0.0, 0.0};
  const std::array y{4.0, 5.0, 1.0, 1.0, 1.0};
  // y orders the pairs 0-1, 0-2, 0-3, 0-4, 1-2, 1-3 and 1-4: the first unlike x, the other six like x.
  EXPECT_DOUBLE_EQ(kendall_tau(x, y), (6.0 - 1.0) / std::sqrt(9.0 * 7.0));
}

TEST(KendallTau, TakesWhatOnlyRoundingTellsApartForEqual) {
  const std::array x{5.0, 4.0, 3.0, 1e-3, std::nextafter(1e-3, 1.0)};
  const std::array y{4.0, 5.0, 1.0, 1.0, std::nextafter(1.0, 0.0)};
  EXPECT_DOUBLE_EQ(kendall_tau(x, y), (6.0 - 1.0) / std::sqrt(9.0 * 7.0));
}

TEST(KendallTau, OrdersWhatIsInfinite) {
  const std::array x{1.0, 2.0, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(kendall_tau(x, std::array{1.0, 2.0, 3.0}), 1.0);
}

TEST(KendallTau, LeavesOutWhatIsNotKnown) {
  const std::array x{1.0, kNaN, 2.0, 3.0};
  const std::array y{2.0, -9.0, 3.0, kNaN};
  EXPECT_EQ(kendall_tau(x, y), 1.0);
  const std::array same{5.0, 5.0, 5.0, 5.0};
  EXPECT_TRUE(std::isnan(kendall_tau(x, same)));
  EXPECT_TRUE(std::isnan(kendall_tau(std::span(x).first(1), std::span(y).first(1))));
}

}  // namespace
}  // namespace poesy
