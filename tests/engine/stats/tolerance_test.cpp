#include "engine/stats/tolerance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace poesy {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The norm of a linear response to three errors at two poses. Its mean square at pose m is b_m^2 + sum over p of (w_pm
/// t_p)^2, with the background b, the weights w and the tolerances t. The third error has no effect.
struct LinearResponse {
  static constexpr std::uint64_t kSamples = 100;
  using Cells = Array<double, axis::Factor, axis::Pose>;

  std::vector<double> sigma{1e-3, 2e-2, 1e-3};
  std::vector<double> background{3e-4, 4e-4};
  Cells weight{{3, 2}, {0.5, 0.7, 0.02, 0.03, 0.0, 0.0}};
  std::vector<double> index{0.4, 0.015, 1e-14};
  std::vector<std::uint64_t> count = std::vector<std::uint64_t>(6, kSamples);
  Cells mean{{3, 2}};
  Cells std{{3, 2}};

  LinearResponse() {
    for (std::size_t p = 0; p < 3; ++p) {
      for (std::size_t m = 0; m < 2; ++m) {
        const double square = std::pow(background[m], 2) + std::pow(weight(p, m) * sigma[p], 2);
        mean(p, m) = 0.6 * std::sqrt(square);
        std(p, m) = 0.8 * std::sqrt(square * kSamples / (kSamples - 1.0));
      }
    }
  }

  ResponseStudy study() const {
    return {index, sigma, {count, {3, 2}}, {mean.all(), {3, 2}}, {std.all(), {3, 2}}, background};
  }

  /// The root mean square over both poses, by its definition.
  double rms(std::span<const double> tolerances) const {
    double sum = 0.0;
    for (std::size_t m = 0; m < 2; ++m) {
      sum += std::pow(background[m], 2);
      for (std::size_t p = 0; p < 2; ++p) sum += std::pow(weight(p, m) * tolerances[p], 2);
    }
    return std::sqrt(sum / 2.0);
  }
};

TEST(Tolerances, OfEqualEffectMakeIndexTimesToleranceConstant) {
  const std::vector<double> index{0.4, 2.0, 0.007, 31.0};
  const auto tolerances = equal_effect_tolerances(index, {2, 0.0175});
  EXPECT_EQ(tolerances[2], 0.0175);
  for (std::size_t p = 0; p < index.size(); ++p) EXPECT_DOUBLE_EQ(index[p] * tolerances[p], 0.007 * 0.0175);
}

TEST(Tolerances, AreUnlimitedWithoutEffectAndUnknownWithoutIndex) {
  const std::vector<double> index{0.5, 0.9 * kIndexRounding, kNaN, 0.0};
  const auto tolerances = equal_effect_tolerances(index, {0, 1e-3});
  EXPECT_EQ(tolerances[1], kInfinity);
  EXPECT_TRUE(std::isnan(tolerances[2]));
  EXPECT_EQ(tolerances[3], kInfinity);
}

TEST(Tolerances, CannotBeCountedFromAReferenceWithoutEffect) {
  for (const std::size_t reference : {1u, 2u}) {
    for (const double tolerance : equal_effect_tolerances(std::vector{0.5, 0.0, kNaN}, {reference, 1e-3})) {
      EXPECT_TRUE(std::isnan(tolerance));
    }
  }
}

TEST(Tolerances, ReferenceOfSmallestEffectSkipsThoseWithoutAny) {
  const std::vector<double> sigma{1e-3, 1e-3, 2e-2, 1e-3};
  EXPECT_EQ(smallest_effect(std::vector{0.0, 0.5, 0.1, kNaN}, sigma), 1u);  // index x sigma: 5e-4 is less than 2e-3
  EXPECT_EQ(smallest_effect(std::vector{0.0, 1e-14, kNaN, kNaN}, sigma), std::nullopt);
}

TEST(MeanSquareOfResponse, IsExactForALinearOne) {
  const LinearResponse response;
  const MeanSquare found = mean_square(response.study());
  EXPECT_DOUBLE_EQ(found.background, (9e-8 + 16e-8) / 2.0);
  EXPECT_NEAR(found.effects[0], (0.25 + 0.49) / 2.0, 1e-12);
  EXPECT_NEAR(found.effects[1], (4e-4 + 9e-4) / 2.0, 1e-14);
  EXPECT_EQ(found.effects[2], 0.0);
  const std::vector<double> tolerances{3e-3, 1e-2, kInfinity};
  EXPECT_NEAR(std::sqrt(found.at(tolerances)), response.rms(tolerances), 1e-14);
}

TEST(MeanSquareOfResponse, IsUnknownWithoutSamplesOrBackground) {
  LinearResponse few;
  few.std(0, 1) = kNaN;
  EXPECT_TRUE(std::isnan(mean_square(few.study()).effects[0]));
  EXPECT_FALSE(std::isnan(mean_square(few.study()).effects[1]));
  LinearResponse unsolved;
  unsolved.background[1] = kNaN;
  EXPECT_TRUE(std::isnan(mean_square(unsolved.study()).background));
  EXPECT_TRUE(std::isnan(mean_square(unsolved.study()).effects[0]));
}

TEST(MeanSquareOfResponse, CountsAnErrorThatOnlyTakesAwayAsNothing) {
  LinearResponse response;
  for (std::size_t m = 0; m < 2; ++m) response.mean(0, m) = response.std(0, m) = 0.0;
  EXPECT_EQ(mean_square(response.study()).effects[0], 0.0);
}

TEST(MeanSquareShares, AreWhatEachErrorAddsOverWhatAllAdd) {
  const LinearResponse response;
  const auto shares = mean_square_shares(mean_square(response.study()), response.sigma);
  std::vector<double> alone;
  for (std::size_t p = 0; p < 3; ++p) {
    std::vector<double> sizes(3, 0.0);
    sizes[p] = response.sigma[p];
    alone.push_back(std::pow(response.rms(sizes), 2) - std::pow(response.rms(std::vector(3, 0.0)), 2));
  }
  const double sum = std::accumulate(alone.begin(), alone.end(), 0.0);
  for (std::size_t p = 0; p < 3; ++p) EXPECT_NEAR(shares[p], alone[p] / sum, 1e-10);
  EXPECT_EQ(shares[2], 0.0);
}

// The first error has the larger global index (mean over the poses plus spread), but the second adds more to the mean
// square.
TEST(MeanSquareShares, DoNotFollowTheIndex) {
  const std::vector<double> mean(4, 0.0);
  const std::vector<std::uint64_t> count(4, 1'000'000);
  const std::vector<double> std{1.0, 3.0, 2.3, 2.3};
  const std::vector<double> index{2.0 + std::sqrt(2.0), 2.3};
  const std::vector<double> sigma{1.0, 1.0};
  const std::vector<double> background{0.0, 0.0};
  const auto shares = mean_square_shares(
      mean_square({index, sigma, {count, {2, 2}}, {mean, {2, 2}}, {std, {2, 2}}, background}), sigma);
  EXPECT_GT(index[0], index[1]);
  EXPECT_NEAR(shares[0], 5.0 / (5.0 + 2.3 * 2.3), 1e-6);
  EXPECT_LT(shares[0], shares[1]);
}

TEST(MeanSquareShares, AreUnknownWhereAnEffectIsUnknownOrNoneIsThere) {
  for (const MeanSquare& response : {MeanSquare{0.0, {0.3, kNaN}}, MeanSquare{0.0, {0.0, 0.0}}}) {
    for (const double share : mean_square_shares(response, std::vector{1.0, 1.0})) EXPECT_TRUE(std::isnan(share));
  }
}

TEST(EqualTolerances, AreInTheProportionOfTheMedians) {
  constexpr auto kMm = Dimension::length;
  constexpr auto kDeg = Dimension::angle;
  const std::vector<double> sigma{1.0, 0.01, 1.0, 0.02, 50.0, 0.04, 0.03};
  const std::vector<Dimension> dimension{kMm, kDeg, kMm, kDeg, kMm, kDeg, kDeg};
  const std::vector<double> expected{1.0, 0.025, 1.0, 0.025, 1.0, 0.025, 0.025};
  EXPECT_EQ(one_size_for_each(sigma, dimension), expected);
  EXPECT_EQ(one_size_for_each(std::vector{2.0}, std::vector{kDeg}), std::vector{2.0});
}

const std::vector<double> kUnbounded(3, kInfinity);

TEST(LimitTolerances, ReachTheLimitExactly) {
  const LinearResponse response;
  const MeanSquare prediction = mean_square(response.study());
  for (const double limit : {4e-4, 1e-3, 0.7}) {
    const LimitTolerances found = limit_tolerances(response.study(), prediction, response.sigma, limit, kUnbounded);
    EXPECT_NEAR(response.rms(found.equal_effect), limit, 1e-12 * limit);
    EXPECT_NEAR(response.rms(found.equal_tolerance), limit, 1e-12 * limit);
  }
}

TEST(LimitTolerances, KeepTheirProportions) {
  const LinearResponse response;
  const std::vector<double> one_size{3.0, 5.0, 5.0};
  const LimitTolerances found =
      limit_tolerances(response.study(), mean_square(response.study()), one_size, 1e-3, kUnbounded);
  EXPECT_DOUBLE_EQ(found.equal_effect[0] * response.index[0], found.equal_effect[1] * response.index[1]);
  EXPECT_EQ(found.equal_effect[2], found.equal_tolerance[2]);
  for (std::size_t p = 1; p < 3; ++p) {
    EXPECT_DOUBLE_EQ(found.equal_tolerance[p] / one_size[p], found.equal_tolerance[0] / one_size[0]);
  }
}

// If an upper bound limits one tolerance, the other tolerances become larger so that the limit is still reached.
TEST(LimitTolerances, AreNoLargerThanTheyMayBe) {
  const LinearResponse response;
  const MeanSquare prediction = mean_square(response.study());
  constexpr double kLimit = 1e-3;
  const auto within = [&](const std::vector<double>& largest) {
    return limit_tolerances(response.study(), prediction, response.sigma, kLimit, largest).equal_effect;
  };
  const std::vector<double> free = within(kUnbounded);
  for (std::size_t p = 0; p < 2; ++p) {
    std::vector<double> largest = kUnbounded;
    largest[p] = 0.5 * free[p];
    const std::vector<double> found = within(largest);
    EXPECT_EQ(found[p], largest[p]);
    EXPECT_GT(found[1 - p], free[1 - p]);
    EXPECT_NEAR(response.rms(found), kLimit, 1e-12 * kLimit);
  }
  const std::vector<double> small{0.5 * free[0], 0.5 * free[1], kUnbounded[2]};
  const std::vector<double> found = within(small);
  EXPECT_EQ(found[0], small[0]);
  EXPECT_EQ(found[1], small[1]);
  EXPECT_LT(response.rms(found), kLimit);
}

TEST(LimitTolerances, ShareWhatErrorsOfAGivenSizeLeave) {
  const LinearResponse response;
  const MeanSquare prediction = mean_square(response.study());
  const std::vector<double> sizes{1.0, 5e-3, 1.0};
  const std::vector<std::size_t> held{1};
  const MeanSquare others = prediction.holding(held, sizes);
  EXPECT_EQ(others.effects, (std::vector<double>{prediction.effects[0], 0.0, prediction.effects[2]}));
  std::vector<double> found = limit_tolerances(response.study(), others, response.sigma, 1e-3, kUnbounded).equal_effect;
  found[1] = sizes[1];
  EXPECT_NEAR(response.rms(found), 1e-3, 1e-15);
  EXPECT_NEAR(std::sqrt(others.at(found)), 1e-3, 1e-15);
}

TEST(LimitTolerances, VanishAsTheLimitNearsTheBackground) {
  LinearResponse response;
  response.index[2] = 0.0;
  const MeanSquare prediction = mean_square(response.study());
  const double limit = std::sqrt(prediction.background) * (1.0 + 1e-10);
  const LimitTolerances found = limit_tolerances(response.study(), prediction, response.sigma, limit, kUnbounded);
  EXPECT_GT(found.equal_effect[0], 0.0);
  EXPECT_LT(found.equal_effect[0], 1e-7);
}

}  // namespace
}  // namespace poesy
