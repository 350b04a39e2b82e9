#include "engine/stats/mean_square_shares.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>

#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"
#include "tests/engine/stats/coverage.h"

namespace poesy {
namespace {

/// The linear fit of a vector with two components at two poses. The responses are exactly linear.
LinearFit example() {
  return {.errors = 3,
          .machines = 1000,
          .offset = std::vector(4, 0.0),
          .slope = {1.0, 0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 2.0, 0.0, 1.0, 0.0, 1e-9},
          .slope_variance = std::vector(12, 0.0),
          .rest = std::vector(4, 0.0),
          .products = {1.0, 0.5, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 1.0}};
}

constexpr std::array<std::size_t, 4> kRows{0, 1, 2, 3};

TEST(MeanSquareShares, AddUpOverComponentsAndPoses) {
  const std::vector<ErrorEffect> errors(3);
  const MeanSquareShares shares = mean_square_shares(example(), kRows, 2, errors, 0.95);
  EXPECT_NEAR(shares.each[0].value, 3.0 / 11.0, 1e-15);
  EXPECT_NEAR(shares.each[1].value, 8.0 / 11.0, 1e-15);
  EXPECT_NEAR(shares.each[0].interval.high, 3.0 / 11.0, 1e-15);
  EXPECT_NEAR(shares.linear, 1.0, 1e-15);
}

TEST(MeanSquareShares, LeaveOutTheMeanAndStateIt) {
  LinearFit fit = example();
  fit.offset = {0.5, -1.0, 0.0, 2.0};
  MeanSquareShares shares = mean_square_shares(fit, kRows, 2, std::vector<ErrorEffect>(3), 0.95);
  EXPECT_NEAR(shares.each[0].value, 3.0 / 11.0, 1e-15);
  EXPECT_NEAR(shares.offset, std::sqrt(5.25 / 2.0), 1e-15);
  EXPECT_NEAR(shares.offset_share, 5.25 / (5.25 + 11.0), 1e-15);
  fit.rest = std::vector(4, 100.0);  // with 1000 machines, the squared means are 0.4 too large
  shares = mean_square_shares(fit, kRows, 2, std::vector<ErrorEffect>(3), 0.95);
  EXPECT_NEAR(shares.offset, std::sqrt(4.85 / 2.0), 1e-15);
}

TEST(MeanSquareShares, OfCorrelatedErrorsAreNotKnown) {
  std::vector<ErrorEffect> errors(3);
  errors[0].block = errors[1].block = 1;
  LinearFit fit = example();
  fit.slope[2] = 3.0;
  const MeanSquareShares shares = mean_square_shares(fit, kRows, 2, errors, 0.95);
  EXPECT_TRUE(std::isnan(shares.each[0].value));
  // The mean square is 3 + 8 from the first two errors, 2 x 0.5 x (1 x 2) from their correlation, and 9 from the third
  // error.
  EXPECT_NEAR(shares.each[2].value, 9.0 / (11.0 + 2.0 + 9.0), 1e-9);
  EXPECT_TRUE(std::isnan(shares.each[2].interval.low) && std::isnan(shares.each[2].interval.high));
}

TEST(MeanSquareShares, OfRoundingAreZeroOrNotKnown) {
  std::vector<ErrorEffect> errors(3);
  for (ErrorEffect& error : errors) error.rounding = 1e-8;
  MeanSquareShares shares = mean_square_shares(example(), kRows, 2, errors, 0.95);
  EXPECT_EQ(shares.each[2].value, 0.0);
  EXPECT_EQ(shares.each[2].interval.high, 0.0);
  EXPECT_GT(shares.each[0].value, 0.0);
  for (ErrorEffect& error : errors) error.rounding = 10.0;
  shares = mean_square_shares(example(), kRows, 2, errors, 0.95);
  for (const Estimate& one : shares.each) EXPECT_TRUE(std::isnan(one.value));
  EXPECT_TRUE(std::isnan(shares.linear));
}

/// y = x_0 + 0.3 x_1 + 0.5 (x_2^2 - 1) with standard normal errors has the mean square 1 + 0.09 + 0.5. The 95 %
/// intervals contain the true shares at least that often: one-sided test with alpha = 1e-3 (z > -3.09) over 2000
/// repetitions.
TEST(MeanSquareShares, HaveIntervalsThatHoldThem) {
  constexpr std::size_t kMachines = 200;
  constexpr double kAll = 1.59;
  const std::array truth{1.0 / kAll, 0.09 / kAll, 0.0};
  boost::random::mt19937_64 engine(8);
  std::array<test::Coverage, 3> coverage;
  std::array<double, 3> sums{};
  constexpr int kRepetitions = 2000;
  for (int n = 0; n < kRepetitions; ++n) {
    std::vector<double> x(3 * kMachines);
    std::vector<double> y(kMachines);
    for (double& one : x) one = normal_quantile(1.0, uniform_from_bits(engine()));
    for (std::size_t b = 0; b < kMachines; ++b) {
      const double square = x[2 * kMachines + b] * x[2 * kMachines + b] - 1.0;
      y[b] = x[b] + 0.3 * x[kMachines + b] + 0.5 * square;
    }
    LinearFitSums fit(3, 1);
    fit.add(x, y, std::vector<std::uint8_t>(kMachines, 1));
    const MeanSquareShares shares =
        mean_square_shares(fit.fit().value(), std::array<std::size_t, 1>{0}, 1, std::vector<ErrorEffect>(3), 0.95);
    for (std::size_t p = 0; p < 3; ++p) {
      coverage[p].add(shares.each[p].interval, truth[p]);
      sums[p] += shares.each[p].value;
    }
  }
  for (std::size_t p = 0; p < 3; ++p) EXPECT_GT(coverage[p].z(), -3.09) << p << ' ' << coverage[p].share();
  EXPECT_NEAR(sums[0] / kRepetitions, truth[0], 0.02);
  EXPECT_NEAR(sums[1] / kRepetitions, truth[1], 0.01);
  EXPECT_LT(sums[2] / kRepetitions, 0.01);
}

}  // namespace
}  // namespace poesy
