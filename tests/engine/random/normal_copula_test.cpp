#include "engine/random/normal_copula.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "engine/random/normal_share.h"

namespace poesy {
namespace {

TEST(NormalShares, AreThoseOfTheDefinition) {
  std::vector<double> values;
  for (int k = -8200; k <= 8200; ++k) values.push_back(k * 1e-3);
  std::vector<double> shares = values;
  normal_shares(shares);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const long double exact =
        0.5L * std::erfc(-static_cast<long double>(values[k]) / std::numbers::sqrt2_v<long double>);
    EXPECT_NEAR(shares[k] / static_cast<double>(exact), 1.0, 1e-14) << values[k];
  }
}

TEST(NormalShares, AreStrictlyInside) {
  std::vector<double> values{-1e300, -40.0, -8.3, 8.3, 40.0, 1e300};
  normal_shares(values);
  for (const double share : values) {
    EXPECT_GT(share, 0.0);
    EXPECT_LT(share, 1.0);
  }
}

const std::vector<double> kCorrelation{1.0, 0.5, -0.25, 0.5, 1.0, 0.125, -0.25, 0.125, 1.0};

TEST(LowerTriangle, HasTheMatrixAsItsSquare) {
  const std::vector<double> l = lower_triangle(kCorrelation);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 3; ++k) sum += l[3 * i + k] * l[3 * j + k];
      EXPECT_NEAR(sum, kCorrelation[3 * i + j], 1e-15);
    }
  }
  EXPECT_EQ(l[1], 0.0);
}

TEST(SmallestEigenvalue, IsKnownForPairs) {
  EXPECT_NEAR(smallest_eigenvalue(std::vector{1.0, 0.75, 0.75, 1.0}), 0.25, 1e-15);
  EXPECT_NEAR(smallest_eigenvalue(std::vector{1.0, -1.0, -1.0, 1.0}), 0.0, 1e-15);
  EXPECT_NEAR(smallest_eigenvalue(std::vector{1.0, 0.9, 0.9, 0.9, 1.0, -0.9, 0.9, -0.9, 1.0}), -0.8, 1e-14);
}

TEST(NormalCopula, MultipliesByTheTriangleColumnByColumn) {
  constexpr std::size_t kCount = 300;
  const NormalCopula copula(kCorrelation);
  const std::vector<double> l = lower_triangle(kCorrelation);
  std::vector<double> all(3 * kCount);
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = std::sin(static_cast<double>(k));
  const std::vector<double> before = all;
  const std::span<double> rows(all);
  copula.correlate(std::vector{rows.subspan(0, kCount), rows.subspan(kCount, kCount), rows.subspan(2 * kCount)});
  for (std::size_t b = 0; b < kCount; ++b) {
    std::vector<double> one{before[b], before[kCount + b], before[2 * kCount + b]};
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j <= i; ++j) sum += l[3 * i + j] * one[j];
      EXPECT_NEAR(all[i * kCount + b], sum, 1e-15);
    }
    const std::span<double> single(one);
    copula.correlate(std::vector{single.subspan(0, 1), single.subspan(1, 1), single.subspan(2, 1)});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(all[i * kCount + b], one[i]);
  }
}

}  // namespace
}  // namespace poesy
