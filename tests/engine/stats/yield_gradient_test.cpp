#include "engine/stats/yield_gradient.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/random/distribution.h"
#include "engine/random/normal_copula.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"
#include "tests/engine/stats/stored_bytes.h"
#include "tests/engine/stats/yield_cases.h"

namespace poesy {
namespace {

using test::expect_no_harm;
using test::read_all;
using test::written;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The reference case: y = a . e with normal errors e and the limit |y| <= limit.
struct Sum {
  std::array<double, 3> a{1.0, 2.0, 0.5};
  std::array<double, 3> sigma{0.1, 0.05, 0.2};
  double limit = 0.3;

  ErrorScores errors() const {
    return {{NormalScore{sigma[0], kInfinity}, NormalScore{sigma[1], kInfinity}, NormalScore{sigma[2], kInfinity}}};
  }
};

/// Random machines of a Sum: errors [3 x machines] and rejects.
struct Machines {
  std::vector<double> errors;
  std::vector<std::uint8_t> rejected;

  Machines(const Sum& sum, std::size_t count, std::uint64_t seed) : errors(3 * count), rejected(count) {
    boost::random::mt19937_64 engine(seed);
    for (double& error : errors) error = uniform_from_bits(engine());
    for (std::size_t p = 0; p < 3; ++p) {
      Distribution::normal(sum.sigma[p]).transform(std::span(errors).subspan(p * count, count));
    }
    for (std::size_t b = 0; b < count; ++b) {
      double y = 0.0;
      for (std::size_t p = 0; p < 3; ++p) y += sum.a[p] * errors[p * count + b];
      rejected[b] = static_cast<std::uint8_t>(std::abs(y) > sum.limit);
    }
  }
};

TEST(YieldGradient, HoldsTheReference) {
  constexpr std::size_t kMachines = 400000;
  const Sum sum;
  const Machines machines(sum, kMachines, 3);
  ScoreSums scores(sum.errors());
  scores.add(machines.errors, machines.rejected);
  EXPECT_NEAR(1.0 - static_cast<double>(scores.rejects()) / kMachines, .9167354833,
              3.291 * std::sqrt(.0764 / kMachines));
  const std::vector<Estimate> gradient = scores.gradient(0.999);
  const std::array expected{-1.02786887, -2.05573773, -.51393443};
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_LT(gradient[p].interval.low, expected[p]);
    EXPECT_GT(gradient[p].interval.high, expected[p]);
    EXPECT_LT(gradient[p].interval.high - gradient[p].interval.low, 0.08 * std::abs(expected[p]));
  }
}

/// One (truncated) normal error e with the limit |e| <= limit. Compares the gradient of the yield from scores of evenly
/// spread machines, without random noise, with the exact one. half_width: where the distribution is cut off.
struct OneError {
  double half_width;
  double limit;

  double yield(double sigma) const {
    const double ends = std::isinf(half_width) ? 1.0 : std::erf(half_width / sigma / std::numbers::sqrt2);
    return std::erf(limit / sigma / std::numbers::sqrt2) / ends;
  }
  double exact(double sigma) const {
    const double step = 1e-4 * sigma;
    return (8.0 * (yield(sigma + step) - yield(sigma - step)) - yield(sigma + 2.0 * step) + yield(sigma - 2.0 * step)) /
           (12.0 * step);
  }
  ScoreSums scores_at(double sigma) const {
    constexpr std::size_t kMachines = 100000;
    std::vector<double> errors(kMachines);
    for (std::size_t k = 0; k < kMachines; ++k) errors[k] = (static_cast<double>(k) + 0.5) / kMachines;
    const auto distribution =
        std::isinf(half_width) ? Distribution::normal(sigma) : Distribution::truncated_normal(sigma, half_width);
    distribution.transform(errors);
    std::vector<std::uint8_t> rejected;
    for (const double error : errors) rejected.push_back(static_cast<std::uint8_t>(std::abs(error) > limit));
    ScoreSums scores(ErrorScores{{NormalScore{sigma, half_width}}});
    scores.add(errors, rejected);
    return scores;
  }
  double from_scores(double sigma) const { return scores_at(sigma).gradient(0.95).front().value; }
  double change(double sigma) const { return scores_at(sigma).change(0.95).front().value; }
};

TEST(YieldGradient, OfNormalAndTruncatedErrorsIsExact) {
  for (const double half_width : {kInfinity, 6.0, 2.5, 1.0}) {
    for (const double limit : {0.3, 0.9}) {
      const OneError error{half_width, limit};
      EXPECT_NEAR(error.from_scores(1.0), error.exact(1.0), 1e-4) << half_width << ' ' << limit;
      EXPECT_NEAR(error.from_scores(0.4), error.exact(0.4), 3e-4) << half_width << ' ' << limit;
    }
  }
}

/// Expects that each 99.9 % interval contains the true gradient and that its half-width is less than `part` of the
/// gradient.
void expect_gradient(const test::YieldCase& yield, std::size_t machines, double part, std::uint64_t seed) {
  boost::random::mt19937_64 engine(seed);
  const std::vector<Estimate> found = yield.estimate(machines, 0.999, engine);
  for (std::size_t p = 0; p < found.size(); ++p) {
    EXPECT_LT(found[p].interval.low, yield.gradient[p]) << p;
    EXPECT_GT(found[p].interval.high, yield.gradient[p]) << p;
    EXPECT_LT(found[p].interval.high - found[p].interval.low, 2.0 * part * std::abs(yield.gradient[p])) << p;
  }
}

TEST(YieldGradient, OfUniformErrorsHoldsTheClosedForm) {
  expect_gradient(test::uniform_case(std::array{0.1, 0.08, 0.15}, 0.32), 1000000, 0.1, 21);
  expect_gradient(test::uniform_case(std::array{0.1, 0.1}, 0.2), 1000000, 0.1, 22);
}

TEST(YieldGradient, OfTriangularErrorsHoldsTheClosedForm) {
  expect_gradient(test::triangular_case(std::array{0.1, 0.08, 0.15}, 0.32), 1000000, 0.1, 23);
}

TEST(YieldGradient, OfMeasuredErrorsHoldsTheClosedForm) {
  const std::vector<double> skewed{-0.3, -0.29, -0.25, -0.2, -0.15, -0.1, 0.0, 0.2, 0.6, 0.9};
  expect_gradient(test::measured_case(skewed, 0.3, 0.8), 1000000, 0.1, 24);
}

/// y = a . e with four errors. All but the second are correlated.
TEST(YieldGradient, OfCorrelatedNormalErrorsHoldsTheClosedForm) {
  constexpr std::size_t kMachines = 200000;
  constexpr double kLimit = 0.4;
  constexpr std::array kSlope{1.0, 1.5, -0.5, 2.0};
  constexpr std::array kSigma{0.1, 0.08, 0.2, 0.05};
  const NormalCopula copula(std::array{1.0, 0.6, -0.2, 0.6, 1.0, 0.3, -0.2, 0.3, 1.0});
  const std::vector<std::size_t> block{0, 2, 3};
  std::vector<double> errors(4 * kMachines);
  boost::random::mt19937_64 engine(25);
  for (double& error : errors) error = uniform_from_bits(engine());
  normal_quantiles(1.0, errors);
  const auto row = [&](std::size_t p) { return std::span(errors).subspan(p * kMachines, kMachines); };
  copula.correlate(std::array{row(0), row(2), row(3)});
  std::vector<double> y(kMachines);
  for (std::size_t p = 0; p < 4; ++p) {
    for (double& error : row(p)) error *= kSigma[p];
    for (std::size_t b = 0; b < kMachines; ++b) y[b] += kSlope[p] * row(p)[b];
  }
  std::vector<std::uint8_t> rejected;
  for (const double one : y) rejected.push_back(static_cast<std::uint8_t>(std::abs(one) > kLimit));
  ScoreSums scores(
      {{BlockScore{kSigma[0]}, NormalScore{kSigma[1], kInfinity}, BlockScore{kSigma[2]}, BlockScore{kSigma[3]}},
       {{block, lower_triangle(copula.correlation())}}});
  scores.add(errors, rejected);
  const std::vector<Estimate> found = scores.gradient(0.999);
  // The variance of y is s' R s with s_i = a_i t_i (slope x sigma) and the correlations R.
  std::array<double, 4> by_size{0.0, kSlope[1] * kSlope[1] * kSigma[1], 0.0, 0.0};
  double variance = by_size[1] * kSigma[1];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      by_size[block[i]] += kSlope[block[i]] * copula.correlation()[3 * i + j] * kSlope[block[j]] * kSigma[block[j]];
    }
    variance += by_size[block[i]] * kSigma[block[i]];
  }
  const double density = std::exp(-0.5 * kLimit * kLimit / variance) / std::sqrt(2.0 * std::numbers::pi);
  for (std::size_t p = 0; p < 4; ++p) {
    const double expected = -2.0 * density * kLimit * by_size[p] / std::pow(variance, 1.5);
    EXPECT_LT(found[p].interval.low, expected) << p;
    EXPECT_GT(found[p].interval.high, expected) << p;
    EXPECT_LT(found[p].interval.high - found[p].interval.low, 0.15) << p;
  }
}

/// The change of the yield if one error becomes 10 % larger: the finite change, not a tenth of the gradient.
TEST(YieldChange, IsThatOfAStep) {
  constexpr std::size_t kMachines = 400000;
  const Sum sum;
  const Machines machines(sum, kMachines, 3);
  ScoreSums scores(sum.errors());
  scores.add(machines.errors, machines.rejected);
  const std::vector<Estimate> change = scores.change(0.999);
  for (std::size_t p = 0; p < 3; ++p) {  // each error causes a third of the variance 0.03
    const double expected = std::erf(0.3 / std::sqrt(2.0 * 0.0321)) - .9167354833;
    EXPECT_LT(change[p].interval.low, expected);
    EXPECT_GT(change[p].interval.high, expected);
    EXPECT_LT(change[p].interval.high - change[p].interval.low, 0.1 * std::abs(expected));
  }
  // For one normal error with a limit at 3 sigma, a tenth of the gradient would be a quarter too small.
  for (const double half_width : {kInfinity, 3.5}) {
    const OneError error{half_width, 3.0};
    const double expected = error.yield(1.1) - error.yield(1.0);
    EXPECT_NEAR(error.change(1.0), expected, 3e-3 * std::abs(expected)) << half_width;
  }
}

/// The yield plus its change is not negative. With few good machines, the sum of the scores alone could give less.
TEST(YieldChange, LeavesNoNegativeYield) {
  ScoreSums scores(ErrorScores{{NormalScore{1.0, kInfinity}}});
  scores.add(std::array{9.0, 9.0, 9.0, 0.1}, std::array<std::uint8_t, 4>{1, 1, 1, 0});
  const Estimate change = scores.change(0.95).front();
  EXPECT_EQ(change.value, -0.25);
  EXPECT_EQ(change.interval.low, -0.25);
  EXPECT_LE(change.interval.high, 0.75);
}

/// If a uniform error alone causes the rejects, polynomials of degree 6 find only a twelfth of the gradient at a yield
/// of 99.73 %. The estimate must then be NaN instead of wrong by more than 30 %.
TEST(YieldGradient, IsNotSaidOfAnErrorThatAloneMakesTheRejects) {
  constexpr std::size_t kMachines = 100000;
  for (const double limit : {0.5, 0.9, 0.9973}) {
    std::vector<double> errors;
    std::vector<std::uint8_t> rejected;
    for (std::size_t k = 0; k < kMachines; ++k) {
      errors.push_back(2.0 * (static_cast<double>(k) + 0.5) / kMachines - 1.0);
      rejected.push_back(static_cast<std::uint8_t>(std::abs(errors.back()) > limit));
    }
    ScoreSums scores(ErrorScores{{test::score_of(Distribution::uniform(1.0))}});
    scores.add(errors, rejected);
    const double slope = scores.gradient(0.95).front().value;
    EXPECT_TRUE(std::isnan(slope) || std::abs(slope * std::sqrt(3.0) / 3.0 / limit + 1.0) < 0.3) << limit << slope;
    EXPECT_EQ(std::isnan(scores.change(0.95).front().value), std::isnan(slope));
  }
}

/// The stored sums for normal errors are those of their scores, bit for bit.
TEST(ScoreSums, OfNormalErrorsAreTheirSquares) {
  constexpr std::size_t kMachines = 501;
  const Sum sum;
  const Machines machines(sum, kMachines, 6);
  ScoreSums scores(sum.errors());
  scores.add(machines.errors, machines.rejected);
  std::array<std::vector<double>, 6> powers;
  std::uint64_t rejects = 0;
  for (std::size_t p = 0; p < 3; ++p) {
    std::array<double, 6> sums{};
    for (std::size_t b = 0; b < kMachines; ++b) {
      if (machines.rejected[b] == 0) continue;
      const double z = machines.errors[p * kMachines + b] * (1.0 / sum.sigma[p]);
      const double score = z * z - 1.0;
      sums[0] += score;
      sums[1] += score * score;
      sums[2] += score * score * score;
      const double growth = 1.0 / 1.1 * std::exp(0.5 * (1.0 - 1.0 / (1.1 * 1.1)) * z * z) - 1.0;
      sums[3] += growth;
      sums[4] += growth * growth;
      sums[5] += growth * growth * growth;
      rejects += p == 0 ? 1 : 0;
    }
    for (std::size_t k = 0; k < 6; ++k) powers[k].push_back(sums[k]);
  }
  ByteWriter to;
  to.number(kMachines);
  to.number(rejects);
  for (const std::vector<double>& one : powers) to.reals(one);
  to.reals(std::array<double, 18>{});  // zeros, because no score is a polynomial
  EXPECT_EQ(written(scores), to.take());
}

TEST(YieldGradient, OfErrorsWithoutAScoreIsNotKnown) {
  ScoreSums scores(ErrorScores{{ErrorScore(), NormalScore{1.0, kInfinity}}});
  scores.add(std::array{0.5, 0.9, -0.9, 2.0, 3.0, 0.1}, std::array<std::uint8_t, 3>{1, 1, 0});
  const std::vector<Estimate> gradient = scores.gradient(0.95);
  EXPECT_TRUE(std::isnan(gradient[0].value));
  EXPECT_TRUE(std::isnan(gradient[0].interval.low));
  EXPECT_DOUBLE_EQ(gradient[1].value, -(3.0 + 8.0) / 3.0);
  EXPECT_LT(gradient[1].interval.low, gradient[1].value);
}

TEST(YieldGradient, NeedsTwoRejectsForAnInterval) {
  ScoreSums scores(ErrorScores{{NormalScore{1.0, kInfinity}}});
  EXPECT_TRUE(std::isnan(scores.gradient(0.95).front().value));
  scores.add(std::array{0.5, 3.0}, std::array<std::uint8_t, 2>{0, 1});
  EXPECT_DOUBLE_EQ(scores.gradient(0.95).front().value, -4.0);
  EXPECT_TRUE(std::isnan(scores.gradient(0.95).front().interval.low));
  EXPECT_TRUE(std::isnan(scores.gradient(0.95).front().interval.high));
}

/// The sums of the same machines in blocks of this size. merged: whether the blocks are merged or added.
ScoreSums in_blocks(std::size_t size, bool merged) {
  constexpr std::size_t kMachines = 1003;
  const Sum sum;
  const Machines machines(sum, kMachines, 4);
  ScoreSums scores(sum.errors());
  for (std::size_t first = 0; first < kMachines; first += size) {
    const std::size_t count = std::min(size, kMachines - first);
    std::vector<double> errors;
    for (std::size_t p = 0; p < 3; ++p) {
      const auto row = machines.errors.begin() + static_cast<std::ptrdiff_t>(p * kMachines + first);
      errors.insert(errors.end(), row, row + static_cast<std::ptrdiff_t>(count));
    }
    ScoreSums block(sum.errors());
    (merged ? block : scores).add(errors, std::span(machines.rejected).subspan(first, count));
    scores.merge(block);
  }
  return scores;
}

TEST(ScoreSums, DoNotDependOnBlocks) {
  const ScoreSums whole = in_blocks(1003, false);
  for (const std::size_t size : {1U, 8U, 100U}) {
    const ScoreSums blocks = in_blocks(size, true);
    EXPECT_EQ(blocks.machines(), whole.machines());
    EXPECT_EQ(blocks.rejects(), whole.rejects());
    for (std::size_t p = 0; p < 3; ++p) {
      const Estimate expected = whole.gradient(0.95)[p];
      EXPECT_NEAR(blocks.gradient(0.95)[p].value, expected.value, 1e-13 * std::abs(expected.value));
      EXPECT_NEAR(blocks.gradient(0.95)[p].interval.low, expected.interval.low,
                  1e-12 * std::abs(expected.interval.low));
    }
    EXPECT_EQ(written(in_blocks(size, true)), written(blocks));
  }
}

TEST(StoredScoreSums, GoOnWithTheSameBits) {
  const auto read = [](ByteReader& from) { return read_state<ScoreSums>(from, Sum{}.errors()); };
  ScoreSums scores = in_blocks(100, true);
  ScoreSums stored = read_all(written(scores), read);
  for (ScoreSums* sums : {&scores, &stored}) sums->merge(in_blocks(8, true));
  EXPECT_EQ(written(stored), written(scores));
  expect_no_harm(written(scores), read);
}

TEST(StoredScoreSums, OfEveryShapeGoOnWithTheSameBits) {
  const ErrorScores scores{{test::score_of(Distribution::uniform(0.5)), BlockScore{0.05}, BlockScore{0.2}},
                           {{{1, 2}, lower_triangle(std::array{1.0, 0.5, 0.5, 1.0})}}};
  const auto read = [&](ByteReader& from) { return read_state<ScoreSums>(from, scores); };
  const Machines machines(Sum{}, 300, 7);
  ScoreSums sums(scores);
  sums.add(machines.errors, machines.rejected);
  ScoreSums stored = read_all(written(sums), read);
  for (ScoreSums* one : {&sums, &stored}) one->add(machines.errors, machines.rejected);
  EXPECT_EQ(written(stored), written(sums));
  for (const Estimate& one : stored.gradient(0.95)) EXPECT_TRUE(std::isfinite(one.interval.low));
  expect_no_harm(written(sums), read);
}

TEST(StoredScoreSums, OfNoMachinesAreRefused) {
  const auto refused = [](std::uint64_t machines, std::uint64_t rejects, double sum, double square, double cube) {
    ByteWriter to;
    to.number(machines);
    to.number(rejects);
    for (int list = 0; list < 4; ++list) to.reals(std::array{sum, square, cube});
    const Bytes bytes = to.take();
    ByteReader from(bytes);
    try {
      read_state<ScoreSums>(from, ErrorScores{{NormalScore{1.0, kInfinity}}, {}});
    } catch (const BytesError&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused(10, 2, 3.0, 5.0, 9.0));
  EXPECT_TRUE(refused(1, 2, 3.0, 5.0, 9.0));
  EXPECT_TRUE(refused(10, 0, 3.0, 5.0, 9.0));
  EXPECT_TRUE(refused(10, 2, 4.0, 5.0, 9.0));
  EXPECT_TRUE(refused(10, 2, 1.0, -5.0, 9.0));
  EXPECT_TRUE(refused(10, 2, kInfinity, kInfinity, 9.0));
  EXPECT_TRUE(refused(10, 2, 3.0, 5.0, kInfinity));
}

}  // namespace
}  // namespace poesy
